// For tests: a driver whose frames are whole bursts.
//
//   request     "ask 3" (block 3); "send A.B" of a user frame; none where the block's station is
//               255
//   reply       "ok", "error 0F"; others belong to no block
//   received    "got A.B" ends the RECEIVE block of frame A.B
//   broken      "broken 02": service_status 2
#pragma once

#include <charconv>
#include <string>

#include "src/p2p/driver.hpp"

namespace fieldproof::p2p::test {

class TestDriver : public P2pDriver {
 public:
  explicit TestDriver(std::string name = "test") : name_(std::move(name)) {}

  std::string_view name() const override { return name_; }
  Status check(const P2pBlock& block, const plc::PlcModel&) const override {
    return block.station == 99 ? Status(fail("station is 99, which this driver has not")) : ok();
  }
  Result<Bytes> request(const P2pBlock& block, const plc::PlcMemory&) override {
    if (block.station == 255) return fail("no such request");
    return to_bytes(block.is_user_frame() ? "send " + block.frame
                                          : "ask " + std::to_string(block.number));
  }
  bool awaits_reply(const P2pBlock& block) const override { return !block.is_user_frame(); }
  std::optional<std::uint16_t> take(const P2pBlock& block, ByteView frame,
                                    plc::PlcMemory& memory) const override {
    const std::string text = to_text(frame);
    if (block.function == P2pBlock::Function::receive) {
      if (text != "got " + block.frame) return std::nullopt;
    } else if (text.starts_with("error ")) {
      return code_in(text);
    } else if (text != "ok") {
      return std::nullopt;
    }
    for (const P2pVariable& variable : block.variables) memory.write(variable.own, 1);
    return p2p_error::none;
  }
  void receive(const Burst& burst, plc::FrameSink& sink) override {
    if (const std::string text = to_text(burst.bytes); text.starts_with("broken "))
      sink.on_broken_frame(code_in(text));
    else
      sink.on_frame(burst.bytes, burst.end());
  }
  std::optional<Time> wake_at() const override { return std::nullopt; }
  void advance(Time, plc::FrameSink&) override {}
  void reset() override {}

 private:
  static std::uint16_t code_in(const std::string& text) {
    std::uint16_t code = 0;
    std::from_chars(text.data() + text.size() - 2, text.data() + text.size(), code, 16);
    return code;
  }

  std::string name_;
};

}  // namespace fieldproof::p2p::test
