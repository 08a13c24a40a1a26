// A small P2P client of one channel (P2P parameter 1): reads a partner's memory when a flag rises.
//
// One value goes out as RSS, several as RSB, in lower case with BCC and an unpadded name (PROTOCOLS.md 'P2P client').
// Result of block b in L, from word 512 + 6b on (000 Appendix 2.1 (3)): bit 0 NDR, bit 1 ERR, + 1 STATUS,
// + 2 service count (dword), + 4 error count (dword). STATUS is a code of Appendix 3.3.
// A flag that is already on when the PLC goes to RUN has not risen.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "src/plc/counters.hpp"
#include "src/plc/memory.hpp"
#include "src/xgt_cnet/codec.hpp"
#include "src/xgt_cnet/receiver.hpp"

namespace fieldproof {

constexpr std::size_t p2p_max_blocks = 32;

/// P2P client error codes (Appendix 3.3).
namespace p2p_error {
constexpr std::uint16_t head = 0x01, tail = 0x02, bcc = 0x03, station = 0x04, protocol = 0x05, time_out = 0x0A, length = 0x0B,
                        not_hex = 0x0D, nak = 0x0F;
}

struct P2pBlock {
  DeviceAddress flag;    // a bit: a request goes out when it rises
  std::string read;      // device name in the partner, sent without leading zeros
  DeviceAddress save;    // where the values go; of the type that `read` has
  unsigned station = 0;  // of the partner
  unsigned count = 1;
};

/// "%MW00100" as it is sent: "%MW100". Dotted names stay as they are.
std::string unpadded_name(std::string_view name);

class XgtClient : private FrameSink {
 public:
  struct Timing {
    Duration gap{};             // inter-character time
    Duration time_out{};        // after the last byte sent
    Duration character_time{};  // of its own line
  };

  /// `memory` outlives the client and holds every address of `blocks`.
  XgtClient(PlcMemory& memory, std::vector<P2pBlock> blocks, const Timing& timing, bool running);

  void receive(const Burst& burst);
  std::optional<Time> wake_at() const;
  Bytes advance(Time now);

  /// Looks at the flags; to be called when memory may have changed.
  void scan();
  /// STOP gives up what is under way.
  void set_running(bool running);
  void power_cycle();
  /// Of all blocks; `status` is that of the last one.
  const ServiceCounters& counters() const { return counters_; }

 private:
  struct Progress {
    bool flag_was_on = false;
    bool wanted = false;
  };

  void on_frame(ByteView frame, Time end) override;
  void on_broken_frame(std::uint16_t why) override;

  std::optional<std::size_t> next_wanted() const;
  Bytes request_of(const P2pBlock& block) const;
  std::uint16_t check(const XgtReply& reply, const P2pBlock& block) const;
  void finish(std::uint16_t error);

  PlcMemory& memory_;
  std::vector<P2pBlock> blocks_;
  Timing timing_;
  bool running_;
  FrameReceiver receiver_;
  ServiceCounters counters_;
  std::vector<Progress> progress_;
  std::optional<std::size_t> waiting_;  // the block whose reply is due
  Time deadline_{};
  bool noise_ = false;                  // bytes without a header came while waiting
  Time now_{};
};

}  // namespace fieldproof
