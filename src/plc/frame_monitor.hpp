// The frame monitor (Cnet EN 11.1.3, Cnet KO 10.1.3): each frame that crosses a channel, with its
// form, result, size, time and data.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "src/line/silence.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::plc {

/// What a frame is: a row of the manual's list, or of this project's where a protocol has none.
struct FrameResult {
  unsigned number = 0;    // as the manual numbers them
  std::string_view text;  // "XGT server"; lives as long as the program
  bool operator==(const FrameResult&) const = default;
};
inline constexpr FrameResult user_definition_frame{5, "User definition frame"};
inline constexpr FrameResult unknown_frame{6, "Unknown"};

struct MonitoredFrame {
  bool sent = false;  // form: transmission, else reception
  FrameResult result = unknown_frame;
  Time time{};  // a transmission begins, a reception ends
  Bytes data;
};

/// "05 30 31": view by HEX.
std::string hex_view(const MonitoredFrame& frame);
/// "[ENQ]01rSS0104%MW0[EOT]40": view by ASCII. What has no name is <7F>, and so are brackets in the
/// data.
std::string ascii_view(const MonitoredFrame& frame);

/// The columns of the monitor's window, with the data in both views; the file ends its lines with
/// CR LF.
std::string csv_header();
/// `time` as it shall stand there: the clock of the PLC, or on XBM-DxxxS the time since the first
/// frame.
std::string csv_row(const MonitoredFrame& frame, std::string_view time);

/// What the monitor must know of the protocol.
struct MonitorRules {
  std::function<std::optional<std::size_t>(ByteView)> frame_length;  // of the first complete frame
  std::function<FrameResult(ByteView frame, bool sent)> classify;
  Duration silence{};  // ends what is no complete frame
};

/// Passes everything on to its device, and back; what crosses its first line is monitored. Also a
/// name of the back door: "@monitor" is the number of the last frame's result, 00 before there is
/// one since power-on.
class FrameMonitor : public EmulatedDevice, public line::Device {
 public:
  using Record = std::function<void(const MonitoredFrame&)>;

  FrameMonitor(std::unique_ptr<EmulatedDevice> device, MonitorRules rules, Record record = {})
      : device_(std::move(device)),
        line_(device_->line()),
        rules_(std::move(rules)),
        record_(std::move(record)),
        silence_(rules_.silence) {}

  line::Device* line(unsigned channel = 0) override {
    line::Device* const of_device = device_->line(channel);
    return of_device && of_device == line_ ? this : of_device;
  }
  net::Host* network() override { return device_->network(); }
  BusEnd* bus_end() override { return device_->bus_end(); }

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  Status set(std::string_view address, std::string_view hex) override {
    return device_->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override;
  Status act(std::string_view action) override;
  Trace trace() const override { return device_->trace(); }

 private:
  void take_frames(Duration character_time);
  void close();
  void record(bool sent, Time time, Bytes data);

  std::unique_ptr<EmulatedDevice> device_;
  line::Device* line_;  // the one that is monitored; nullptr: the device has none
  MonitorRules rules_;
  Record record_;
  Bytes heard_;  // since the last reception
  line::Silence silence_;
  std::optional<FrameResult> last_;
};

}  // namespace fieldproof::plc
