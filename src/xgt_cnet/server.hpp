// The XGT dedicated server of one channel: RSS RSB WSS WSB X Y (Cnet EN and KO chapter 7,
// Appendix 3.1; DECISIONS.md 'XGT Cnet server'). It answers in RUN and STOP. What a reader of the
// manuals may not expect: cnet/bcc-digits, cnet/unknown-command, cnet/registration-numbers,
// cnet/registration-number-form, cnet/name-length, cnet/sb-count.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "src/plc/counters.hpp"
#include "src/plc/memory.hpp"
#include "src/plc/reply_queue.hpp"
#include "src/plc/service.hpp"
#include "src/xgt_cnet/codec.hpp"
#include "src/xgt_cnet/receiver.hpp"

namespace fieldproof::xgt_cnet {

class XgtServer : public plc::LineService, private plc::FrameSink {
 public:
  /// `gap`: inter-character time. `delay`: from the end of a request to its reply. `memory`
  /// outlives the server.
  XgtServer(plc::PlcMemory& memory, unsigned station, Duration gap, Duration delay);

  void receive(const Burst& burst) override { receiver_.receive(burst, *this); }
  std::optional<Time> wake_at() const override { return replies_.wake_at(receiver_.wake_at()); }
  Bytes advance(Time now) override;

  const plc::ServiceCounters& counters() const override { return counters_; }
  /// Registrations, counters and frames in progress are lost.
  void power_cycle() override;

 private:
  using Addresses = std::array<plc::DeviceAddress, xgt_max_blocks>;
  struct Registration {
    XgtService content = XgtService::unknown;  // read_blocks or read_run; unknown: free
    std::vector<plc::DeviceAddress> addresses;
    unsigned count = 0;
  };

  void on_frame(ByteView frame, Time end) override;
  void on_broken_frame(std::uint16_t why) override { counters_.count_error(why); }

  void check_names(XgtRequest& request, Addresses& addresses) const;
  void execute(const XgtRequest& request, const Addresses& addresses, XgtReply& reply);
  void read_blocks(std::span<const plc::DeviceAddress> addresses, XgtReply& reply);
  /// One block of `count` elements.
  void add_data(const plc::DeviceAddress& first, unsigned count, XgtReply& reply);
  void write(const XgtRequest& request, const Addresses& addresses);

  plc::PlcMemory& memory_;
  unsigned station_;
  Duration delay_;
  FrameReceiver receiver_;
  plc::ServiceCounters counters_;
  std::array<Registration, xgt_registrations> registrations_;
  plc::ReplyQueue replies_;
  std::array<char, 256> data_;  // digits of the reply in progress: 16 lwords, or 120 bytes
};

}  // namespace fieldproof::xgt_cnet
