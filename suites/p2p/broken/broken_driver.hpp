// The good driver of a protocol, with a fault in what it asks or takes.
#pragma once

#include <memory>
#include <utility>

#include "suites/p2p/broken/broken_client.hpp"

namespace fieldproof::p2p_broken {

/// `asked` is told before each request.
class BrokenDriver : public p2p::P2pDriver {
 public:
  using Asked = std::function<void(const p2p::P2pBlock& block)>;
  BrokenDriver(std::unique_ptr<p2p::P2pDriver> good, const Behaviour& behaviour, Asked asked)
      : good_(std::move(good)), behaviour_(behaviour), asked_(std::move(asked)) {}

  std::string_view name() const override { return good_->name(); }
  Status check(const p2p::P2pBlock& block, const plc::PlcModel& model) const override {
    return good_->check(block, model);
  }
  Result<Bytes> request(const p2p::P2pBlock& block, const plc::PlcMemory& memory) override {
    asked_(block);
    last_ = block;
    return behaviour_.asks ? behaviour_.asks(*good_, block, memory) : good_->request(block, memory);
  }
  bool awaits_reply(const p2p::P2pBlock& block) const override {
    return good_->awaits_reply(block);
  }
  std::optional<std::uint16_t> take(const p2p::P2pBlock& block, ByteView frame,
                                    plc::PlcMemory& memory) const override {
    if (!behaviour_.takes) return good_->take(block, frame, memory);
    return behaviour_.takes(*good_, block, Bytes(frame.begin(), frame.end()), memory);
  }
  void receive(const Burst& burst, plc::FrameSink& sink) override { good_->receive(burst, sink); }
  std::optional<Time> wake_at() const override { return good_->wake_at(); }
  void advance(Time now, plc::FrameSink& sink) override { good_->advance(now, sink); }
  void reset() override {
    if (!behaviour_.keeps_rests) good_->reset();
  }

  /// Takes a frame for the reply to the last request, although that is over.
  void take_late(ByteView frame, plc::PlcMemory& memory) const {
    if (last_) (void)take(*last_, frame, memory);
  }

 private:
  std::unique_ptr<p2p::P2pDriver> good_;
  std::optional<p2p::P2pBlock> last_;
  Behaviour behaviour_;
  Asked asked_;
};

}  // namespace fieldproof::p2p_broken
