// The P2P driver 'XGT client' of an Ethernet module (FEnet EN 7.2.2 (1), 7.5): single variables go
// as one individual request of up to four blocks, a run as a continuous one, which knows bytes
// alone: three words from %MW100 on are 6 bytes from %MB200 on (5.2.4). Names go out unpadded
// (DECISIONS.md p2p/xgt-requests).
//
// Requests have the company id LSIS-XGT and are numbered from 1 on by the invoke id; a frame with
// another id, another company, or not from a server is no reply to the one under way, which goes
// on waiting (fenet/p2p-requests). Of the rest of a reply's header nothing is looked at but its
// length.
//
// STATUS (fenet/p2p-status): the server's code of a refusal; else Cnet EN Appendix 3.3:
//   05  another command or data type     0E  so many more bytes than asked for that they run
//   0B  length of frame or body, number      over the end of the save area
//       or size of blocks                0F  a refusal without a code
#pragma once

#include <memory>

#include "src/p2p/driver.hpp"
#include "src/xgt_fenet/header.hpp"
#include "src/xgt_fenet/splitter.hpp"

namespace fieldproof::xgt_fenet {

class FenetP2pDriver : public p2p::P2pDriver {
 public:
  std::string_view name() const override { return "xgt-client"; }
  Status check(const p2p::P2pBlock& block, const plc::PlcModel& model) const override;
  Result<Bytes> request(const p2p::P2pBlock& block, const plc::PlcMemory& memory) override;
  bool awaits_reply(const p2p::P2pBlock&) const override { return true; }
  std::optional<std::uint16_t> take(const p2p::P2pBlock& block, ByteView frame,
                                    plc::PlcMemory& memory) const override;

  /// A datagram is one frame.
  void receive(const Burst& burst, plc::FrameSink& sink) override;
  std::optional<Time> wake_at() const override { return std::nullopt; }
  void advance(Time, plc::FrameSink&) override {}
  void reset() override { splitter_ = {}; }

 private:
  bool is_reply(const Header& header) const;

  FrameSplitter splitter_;
  std::uint16_t invoke_ = 0;  // of the last request
};

}  // namespace fieldproof::xgt_fenet
