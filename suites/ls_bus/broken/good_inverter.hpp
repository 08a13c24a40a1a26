// The good inverter behind a fault, and frames as text that faults edit.
#pragma once

#include <string>
#include <string_view>

#include "src/ls_bus/codec.hpp"
#include "suites/broken/good_device.hpp"

namespace fieldproof::ls_bus_broken {

class GoodInverter : public broken::GoodDevice {
 public:
  GoodInverter(std::unique_ptr<plc::EmulatedDevice> device, unsigned station)
      : broken::GoodDevice(std::move(device)), station_(station) {}
  unsigned station() const { return station_; }

 private:
  unsigned station_;
};

// Where parts stand in the content of a write with the address first, and the digits of a word.
constexpr std::size_t count_at = 4, data_at = 5, word_size = 4;

std::string in_lower_case(std::string text);

/// A frame taken apart: what a fault edits as text.
struct FrameText {
  char head = 0;
  std::string body;  // station, command, content
  std::string sum;
  std::string tail = "\x04";

  char command() const { return body.size() > 2 ? body[2] : '\0'; }
  std::string content() const { return body.size() > 3 ? body.substr(3) : std::string(); }
  void set_content(std::string_view text) { body = body.substr(0, 3) + std::string(text); }
  bool is_ack() const { return head == static_cast<char>(ls_bus::ls_ack); }
  bool is_nak() const { return head == static_cast<char>(ls_bus::ls_nak); }
  /// The right sum.
  void seal();
  bool is_sealed() const;
  /// Nothing where there is no header.
  Bytes bytes() const { return head == 0 ? Bytes{} : to_bytes(head + body + sum + tail); }
};

/// A frame with a header and EOT; where it is too short for a sum, all of it is body.
FrameText take_apart(ByteView frame);

/// The low byte of the sum, as two upper-case hex digits.
std::string sum_of(std::string_view text);

FrameText ack_to(const FrameText& request, std::string_view content);
FrameText nak_to(const FrameText& request, std::string_view code);

}  // namespace fieldproof::ls_bus_broken
