#include "src/ls_bus/p2p_driver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/line/silence.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::ls_bus {

using p2p::P2pBlock;
using plc::FrameSink;
using plc::PlcMemory;

namespace {

constexpr std::uint32_t addresses = 0x10000;

bool writes(const P2pBlock& block) { return block.function == P2pBlock::Function::write; }

class LsBusP2pDriver : public p2p::P2pDriver {
 public:
  LsBusP2pDriver(LsWriteOrder write_order, Duration gap)
      : write_order_(write_order), silence_(gap) {}

  std::string_view name() const override { return "ls-bus-client"; }
  Status check(const P2pBlock& block, const plc::PlcModel& model) const override;
  Result<Bytes> request(const P2pBlock& block, const PlcMemory& memory) override;
  bool awaits_reply(const P2pBlock&) const override { return true; }
  std::optional<std::uint16_t> take(const P2pBlock& block, ByteView frame,
                                    PlcMemory& memory) const override;

  void receive(const Burst& burst, FrameSink& sink) override;
  std::optional<Time> wake_at() const override;
  void advance(Time now, FrameSink& sink) override;
  void reset() override {
    receiver_.reset();
    noise_ = false;
  }

 private:
  void take_byte(Byte b, Time end, FrameSink& sink);
  std::uint16_t take_ack(const P2pBlock& block, const LsReply& reply, PlcMemory& memory) const;

  LsWriteOrder write_order_;
  line::Silence silence_;
  LsReceiver receiver_{LsReceiver::Side::client};
  bool noise_ = false;  // a run of bytes outside frames, already told
  LsRequest sent_;      // the reply to a write repeats its data, whatever memory holds by then
};

Status LsBusP2pDriver::check(const P2pBlock& block, const plc::PlcModel&) const {
  if (block.function != P2pBlock::Function::read && !writes(block))
    return fail("function is neither read nor write; an LS Bus client has no other (8.1.2)");
  if (block.type != 'W') return fail("type is not word; the LS Bus has no other (8.2)");
  if (block.variables.size() != 1)
    return fail(
        fmt::format("there are {} variables; an LS Bus block has one, and a run of up to {} words",
                    block.variables.size(), ls_max_words));
  const unsigned count = block.elements();
  if (count == 0 || count > ls_max_words)
    return fail(
        fmt::format("size is {}; an LS Bus block has 1 to {} words (8.2)", count, ls_max_words));
  const char *own = writes(block) ? "read" : "save", *partner = writes(block) ? "save" : "read";
  const std::string& text = block.variables.front().partner;
  const std::optional<unsigned> address = parse_ls_address(text);
  if (!address)
    return fail(
        fmt::format("{} '{}' is no address of an inverter; write four hex digits, such as 1230",
                    partner, text));
  if (*address + count > addresses)
    return fail(
        fmt::format("{} '{}' and the {} words from there on go past FFFF", partner, text, count));
  if (block.variables.front().own.type != 'W')
    return fail(fmt::format("{} is not a word of this PLC; name one such as %MW100", own));
  return ok();
}

Result<Bytes> LsBusP2pDriver::request(const P2pBlock& block, const PlcMemory& memory) {
  const p2p::P2pVariable& variable = block.variables.front();
  sent_ = {.station = block.station,
           .command = writes(block) ? 'W' : 'R',
           .address = *parse_ls_address(variable.partner),
           .count = block.elements()};
  for (unsigned i = 0; writes(block) && i < sent_.count; ++i)
    sent_.data.at(i) = static_cast<std::uint16_t>(memory.read(variable.own + i));
  return encode_ls_request(sent_, write_order_);
}

std::optional<std::uint16_t> LsBusP2pDriver::take(const P2pBlock& block, ByteView frame,
                                                  PlcMemory& memory) const {
  constexpr std::size_t code_size =
      2;  // of a NAK (8.2.1; the four of 8.1.1 contradict every format)
  const LsReply reply = parse_ls_reply(frame);
  if (!reply.whole) return p2p::p2p_error::length;
  if (!reply.sum_right) return p2p::p2p_error::bcc;
  if (!reply.station) return p2p::p2p_error::not_hex;
  if (reply.station != block.station) return p2p::p2p_error::station;
  if (reply.command != sent_.command) return p2p::p2p_error::driver;
  if (!reply.ack)
    return reply.content.size() == code_size ? p2p::p2p_error::nak : p2p::p2p_error::length;
  return take_ack(block, reply, memory);
}

std::uint16_t LsBusP2pDriver::take_ack(const P2pBlock& block, const LsReply& reply,
                                       PlcMemory& memory) const {
  if (reply.content.size() != digits_of_a_word * sent_.count) return p2p::p2p_error::length;
  const std::optional<std::vector<std::uint16_t>> words = ls_words(reply.content);
  if (!words) return p2p::p2p_error::not_hex;
  if (writes(block))
    return std::equal(words->begin(), words->end(), sent_.data.begin()) ? p2p::p2p_error::none
                                                                        : p2p::p2p_error::driver;
  for (std::uint32_t i = 0; i < sent_.count; ++i)
    memory.write(block.variables.front().own + i, (*words)[i]);
  return p2p::p2p_error::none;
}

void LsBusP2pDriver::receive(const Burst& burst, FrameSink& sink) {
  if (burst.bytes.empty()) return;
  burst.for_each([&](Byte b, Time end) { take_byte(b, end, sink); });
  silence_.heard(burst);
}

void LsBusP2pDriver::take_byte(Byte b, Time end, FrameSink& sink) {
  const bool was_inside = receiver_.inside();
  if (receiver_.take(b)) {
    noise_ = false;
    return sink.on_frame(receiver_.frame(), end);
  }
  if (receiver_.inside()) return;
  if (was_inside) return sink.on_broken_frame(plc::service_status::too_long);
  if (!noise_) sink.on_broken_frame(plc::service_status::head);
  noise_ = true;
}

std::optional<Time> LsBusP2pDriver::wake_at() const {
  if (!receiver_.inside()) return std::nullopt;
  return silence_.over_at();
}

void LsBusP2pDriver::advance(Time now, FrameSink& sink) {
  const auto wake = wake_at();
  if (!wake || now < *wake) return;
  reset();
  sink.on_broken_frame(plc::service_status::tail);
}

}  // namespace

std::unique_ptr<p2p::P2pDriver> make_ls_bus_p2p_driver(LsWriteOrder write_order, Duration gap) {
  return std::make_unique<LsBusP2pDriver>(write_order, gap);
}

}  // namespace fieldproof::ls_bus
