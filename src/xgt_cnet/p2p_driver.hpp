// The P2P driver 'XGT client' (Cnet EN 6.2.3, Cnet KO 6.3): single variables go as one RSS or WSS
// of up to four blocks, a run as RSB or WSB, in lower case with BCC and unpadded names
// (DECISIONS.md p2p/xgt-requests).
//
// Error codes of Appendix 3.3: a reply that repeats another command or type is of another driver,
// 05; one with more values than asked for, or fewer, is 0B, and 0E where the surplus would run over
// the end of the save area.
#pragma once

#include <string>
#include <string_view>

#include "src/p2p/driver.hpp"
#include "src/xgt_cnet/codec.hpp"
#include "src/xgt_cnet/receiver.hpp"

namespace fieldproof::xgt_cnet {

class XgtP2pDriver : public p2p::P2pDriver {
 public:
  /// `gap`: the inter-character time.
  explicit XgtP2pDriver(Duration gap) : receiver_(FrameReceiver::Side::client, gap) {}

  std::string_view name() const override { return "xgt-client"; }
  Status check(const p2p::P2pBlock& block, const plc::PlcModel& model) const override;
  Result<Bytes> request(const p2p::P2pBlock& block, const plc::PlcMemory& memory) override;
  bool awaits_reply(const p2p::P2pBlock&) const override { return true; }
  std::optional<std::uint16_t> take(const p2p::P2pBlock& block, ByteView frame,
                                    plc::PlcMemory& memory) const override;

  void receive(const Burst& burst, plc::FrameSink& sink) override {
    receiver_.receive(burst, sink);
  }
  std::optional<Time> wake_at() const override { return receiver_.wake_at(); }
  void advance(Time now, plc::FrameSink& sink) override { receiver_.advance(now, sink); }
  void reset() override { receiver_.reset(); }

 private:
  FrameReceiver receiver_;
};

}  // namespace fieldproof::xgt_cnet
