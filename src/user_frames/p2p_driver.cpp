#include "src/user_frames/p2p_driver.hpp"

#include <algorithm>

#include "src/user_frames/block_frame.hpp"
#include "src/user_frames/finder.hpp"

namespace fieldproof::user_frames {

using p2p::P2pBlock;

namespace {

/// The frames of RECEIVE blocks, in the order of the definition.
std::vector<const UserFrame*> armed_frames(const FrameDefinition& definition,
                                           std::span<const P2pBlock> blocks) {
  std::vector<const UserFrame*> frames = user_frames::received_frames(definition);
  std::erase_if(frames, [blocks](const UserFrame* frame) {
    return std::ranges::none_of(blocks, [frame](const P2pBlock& block) {
      return block.function == P2pBlock::Function::receive && block.frame == frame->name;
    });
  });
  return frames;
}

class UserFrameP2pDriver : public p2p::P2pDriver {
 public:
  UserFrameP2pDriver(FrameDefinition definition, std::span<const P2pBlock> blocks, Duration gap,
                     bool network)
      : definition_(std::move(definition)),
        network_(network),
        gap_(gap),
        finder_(armed_frames(definition_, blocks), gap) {}

  std::string_view name() const override { return "user-frames"; }

  Status check(const P2pBlock& block, const plc::PlcModel& model) const override {
    if (definition_.plc != &model)
      return fail(std::string("the definition is for ") + std::string(definition_.plc->name) +
                  ", not for " + std::string(model.name) +
                  "; set plc in the definition, or use that model");
    const Result<UserFrame> frame = frame_of_block(definition_, block);
    return frame ? ok() : Status(frame.error());
  }

  Result<Bytes> request(const P2pBlock& block, const plc::PlcMemory& memory) override {
    return build_frame(*frame_of_block(definition_, block), memory);
  }
  bool awaits_reply(const P2pBlock&) const override { return false; }

  std::optional<std::uint16_t> take(const P2pBlock& block, ByteView bytes,
                                    plc::PlcMemory& memory) const override {
    if (block.function != P2pBlock::Function::receive || block.frame != found_) return std::nullopt;
    const UserFrame frame = *frame_of_block(definition_, block);
    switch (store(frame, match_frame(frame, bytes, true), bytes, memory)) {
      case Stored::yes: break;
      case Stored::not_hex: return p2p::p2p_error::not_hex;
      case Stored::beyond_area: return p2p::p2p_error::range;
    }
    return p2p::p2p_error::none;
  }

  void receive(const Burst& burst, plc::FrameSink& sink) override {
    Heard heard(*this, sink);
    if (burst.event == LinkEvent::datagram) finder_.reset();
    finder_.receive(burst, heard);
    if (burst.event != LinkEvent::datagram) return;
    finder_.advance(burst.end() + 2 * gap_, heard);
    finder_.reset();
  }
  std::optional<Time> wake_at() const override { return finder_.wake_at(); }
  void advance(Time now, plc::FrameSink& sink) override {
    Heard heard(*this, sink);
    finder_.advance(now, heard);
  }
  void reset() override { finder_.reset(); }

 private:
  /// Remembers which frame it is that goes to the sink: the same bytes may be another one too.
  class Heard : public FrameFinder::Sink {
   public:
    Heard(UserFrameP2pDriver& driver, plc::FrameSink& to) : driver_(driver), to_(to) {}
    void on_user_frame(const UserFrame& frame, const FrameMatch&, ByteView bytes,
                       Time end) override {
      driver_.found_ = frame.name;
      to_.on_frame(bytes, end);
    }
    void on_no_frame(std::uint16_t why) override {
      if (!driver_.network_) to_.on_broken_frame(why);
    }

   private:
    UserFrameP2pDriver& driver_;
    plc::FrameSink& to_;
  };

  const FrameDefinition definition_;
  const bool network_;
  const Duration gap_;
  FrameFinder finder_;
  std::string found_;
};

}  // namespace

std::unique_ptr<p2p::P2pDriver> make_user_frame_p2p_driver(FrameDefinition definition,
                                                           std::span<const P2pBlock> blocks,
                                                           Duration gap) {
  return std::make_unique<UserFrameP2pDriver>(std::move(definition), blocks, gap, false);
}

std::unique_ptr<p2p::P2pDriver> make_user_frame_network_driver(FrameDefinition definition,
                                                               std::span<const P2pBlock> blocks,
                                                               Duration gap) {
  return std::make_unique<UserFrameP2pDriver>(std::move(definition), blocks, gap, true);
}

}  // namespace fieldproof::user_frames
