#include "src/modbus/p2p_driver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/modbus/frame.hpp"
#include "src/modbus/p2p_address.hpp"
#include "src/modbus/pdu.hpp"
#include "src/modbus/receiver.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {

using p2p::P2pBlock;
using plc::FrameSink;
using plc::PlcMemory;

namespace {

constexpr Byte exception_bit = 0x80;
constexpr std::uint32_t data_addresses = 0x10000;

struct DriverRules {
  ModbusMode mode{};
  std::string_view name;
  unsigned read_bits = 0, read_words = 0, write_bits = 0, write_words = 0;  // at most

  unsigned most_elements(bool write, bool bits) const {
    return write ? (bits ? write_bits : write_words) : (bits ? read_bits : read_words);
  }
};

/// Cnet KO 6.4.2 '6 data size'; TCP: what the protocol carries.
constexpr DriverRules rules_of(ModbusMode mode) {
  switch (mode) {
    case ModbusMode::rtu: return {mode, "modbus-rtu-client", 2000, 120, 1968, 120};
    case ModbusMode::ascii: return {mode, "modbus-ascii-client", 976, 61, 944, 59};
    case ModbusMode::tcp: break;
  }
  return {mode, "modbus-tcp-client", 2000, 125, 1968, tcp_write_limit};
}

bool writes(const P2pBlock& block) { return block.function == P2pBlock::Function::write; }

/// The values of `count` elements as they stand in a frame: bits from bit 0 of the first byte on,
/// words high byte first.
Bytes read_values(const plc::DeviceAddress& from, unsigned count, const PlcMemory& memory) {
  const bool bits = from.type == 'X';
  Bytes bytes(bits ? (count + 7) / 8 : 0);
  for (unsigned i = 0; i < count; ++i) {
    if (bits)
      bytes[i / 8] = static_cast<Byte>(bytes[i / 8] | memory.read(from + i) << i % 8);
    else
      put_word(bytes, memory.read(from + i));
  }
  return bytes;
}

void write_values(const plc::DeviceAddress& to, unsigned count, ByteView bytes, PlcMemory& memory) {
  for (unsigned i = 0; i < count; ++i) {
    if (to.type == 'X')
      memory.write(to + i, bytes[i / 8] >> i % 8 & 1);
    else
      memory.write(to + i, static_cast<std::uint64_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]));
  }
}

/// `block` was checked.
ModbusP2pAddress partner_of(const P2pBlock& block) {
  return *parse_modbus_p2p_address(block.variables.front().partner);
}

Bytes request_pdu(const P2pBlock& block, const PlcMemory& memory) {
  const ModbusP2pAddress partner = partner_of(block);
  const plc::DeviceAddress& own = block.variables.front().own;
  Bytes pdu{modbus_p2p_function(block, partner)};
  put_word(pdu, partner.address);
  if (!writes(block)) {
    put_word(pdu, block.elements());
  } else if (!block.continuous) {
    const std::uint64_t value = memory.read(own);
    put_word(pdu, !partner.bits() ? value : value != 0 ? coil_on : coil_off);
  } else {
    const Bytes values = read_values(own, block.size, memory);
    put_word(pdu, block.size);
    pdu.push_back(static_cast<Byte>(values.size()));
    pdu.insert(pdu.end(), values.begin(), values.end());
  }
  return pdu;
}

/// Tells the broken frames of a receiver apart: what Modbus servers count as one status has two
/// codes in Appendix 3.3.
class ClientSink : public FrameSink {
 public:
  ClientSink(FrameSink& to, std::uint16_t broken) : to_(to), broken_(broken) {}
  void on_frame(ByteView frame, Time end) override { to_.on_frame(frame, end); }
  void on_broken_frame(std::uint16_t why) override {
    to_.on_broken_frame(why == plc::service_status::not_modbus ? broken_ : why);
  }

 private:
  FrameSink& to_;
  std::uint16_t broken_;
};

class ModbusP2pDriver : public p2p::P2pDriver {
 public:
  ModbusP2pDriver(ModbusMode mode, Duration gap)
      : rules_(rules_of(mode)), receiver_(make_modbus_receiver(mode, gap)) {}

  std::string_view name() const override { return rules_.name; }
  Status check(const P2pBlock& block, const plc::PlcModel& model) const override;
  Result<Bytes> request(const P2pBlock& block, const PlcMemory& memory) override {
    sent_ = request_pdu(block, memory);
    return encode_modbus_frame(rules_.mode, static_cast<Byte>(block.station), sent_,
                               ++transaction_);
  }
  bool awaits_reply(const P2pBlock&) const override { return true; }
  std::optional<std::uint16_t> take(const P2pBlock& block, ByteView bytes,
                                    PlcMemory& memory) const override;

  void receive(const Burst& burst, FrameSink& sink) override {
    ClientSink client(sink, plc::service_status::head);
    receiver_->receive(burst, client);
  }
  std::optional<Time> wake_at() const override { return receiver_->wake_at(); }
  void advance(Time now, FrameSink& sink) override {
    ClientSink client(sink, plc::service_status::tail);
    receiver_->advance(now, client);
  }
  void reset() override { receiver_->reset(); }

 private:
  bool is_for_us(const ModbusFrame& frame) const;
  bool is_echo(ByteView pdu) const;
  std::uint16_t fault_of(const ModbusFrame& frame, ByteView bytes) const;
  std::uint16_t take_pdu(const P2pBlock& block, ByteView pdu, PlcMemory& memory) const;

  DriverRules rules_;
  std::unique_ptr<ModbusReceiver> receiver_;
  Bytes sent_;  // the last PDU: the reply to a write repeats it, whatever memory holds by then
  std::uint16_t transaction_ = 0;  // the last
};

Status ModbusP2pDriver::check(const P2pBlock& block, const plc::PlcModel&) const {
  if (block.function != P2pBlock::Function::read && !writes(block))
    return fail(
        "function is neither read nor write; a Modbus client has no other (Cnet EN 11.1.4: FFFE)");
  if (block.type != 'X' && block.type != 'W')
    return fail("type is neither bit nor word; a Modbus client has no other (Cnet KO 6.4.2)");
  if (block.variables.size() != 1)
    return fail(fmt::format("there are {} variables; a Modbus block has one (Cnet EN table 6.2.4)",
                            block.variables.size()));
  const bool bits = block.type == 'X';
  const unsigned most = rules_.most_elements(writes(block), bits);
  if (block.elements() == 0 || block.elements() > most)
    return fail(fmt::format("size is {}; a {} block {}s 1 to {} {}s (Cnet KO 6.4.2)", block.size,
                            name(), writes(block) ? "write" : "read", most, bits ? "bit" : "word"));
  const char* key = writes(block) ? "save" : "read";
  const std::string& text = block.variables.front().partner;
  const auto wrong = [&](const std::string& what) {
    return fail(
        fmt::format("{} '{}' {} (Cnet EN 11.1.4: FFFE, Modbus address error)", key, text, what));
  };
  const std::optional<ModbusP2pAddress> partner = parse_modbus_p2p_address(text);
  if (!partner)
    return wrong(
        "is no Modbus address; write 0x, the table (0, 1, 3 or 4) and four hex digits, such as "
        "0x40001");
  if (partner->bits() != bits)
    return wrong(
        fmt::format("holds {}s, and type is {}; {}", bits ? "word" : "bit", bits ? "bit" : "word",
                    bits ? "bits are in the tables 0 and 1" : "words are in the tables 3 and 4"));
  if (writes(block) && !partner->writable())
    return wrong("can only be read; write to the tables 0 and 4");
  if (partner->address + block.elements() > data_addresses)
    return wrong(fmt::format("and the {} elements from there on go past data address FFFF",
                             block.elements()));
  if (block.variables.front().own.type != block.type)
    return fail(
        fmt::format("{} is not a {} of this PLC; type is {}", writes(block) ? "read" : "save",
                    bits ? "bit" : "word",
                    bits ? "bit: name one such as %MX00010" : "word: name one such as %MW100"));
  return ok();
}

/// By TCP the transaction tells replies apart; what is of another one, or no Modbus, is left alone.
bool ModbusP2pDriver::is_for_us(const ModbusFrame& frame) const {
  return frame.fault == plc::service_status::normal && frame.transaction == transaction_;
}

/// Of a two-wire line that is set for RS-422; by TCP nothing comes back by itself. (p2p/echo)
bool ModbusP2pDriver::is_echo(ByteView pdu) const {
  return rules_.mode != ModbusMode::tcp && std::ranges::equal(pdu, sent_);
}

std::uint16_t ModbusP2pDriver::fault_of(const ModbusFrame& frame, ByteView bytes) const {
  if (frame.fault == plc::service_status::normal) return p2p::p2p_error::none;
  if (frame.fault == plc::service_status::not_hex) return p2p::p2p_error::not_hex;
  const std::size_t shortest = encode_modbus_frame(rules_.mode, 0, Bytes{0}).size();
  return bytes.size() < shortest ? p2p::p2p_error::length : p2p::p2p_error::bcc;
}

std::optional<std::uint16_t> ModbusP2pDriver::take(const P2pBlock& block, ByteView bytes,
                                                   PlcMemory& memory) const {
  const ModbusFrame frame = decode_modbus_frame(rules_.mode, bytes);
  if (rules_.mode == ModbusMode::tcp && !is_for_us(frame)) return std::nullopt;
  if (const std::uint16_t fault = fault_of(frame, bytes); fault != p2p::p2p_error::none)
    return fault;
  if (frame.station != block.station) return p2p::p2p_error::station;
  const std::uint16_t status = take_pdu(block, frame.pdu, memory);
  if (status == p2p::p2p_error::length && is_echo(frame.pdu)) return std::nullopt;
  return status;
}

std::uint16_t ModbusP2pDriver::take_pdu(const P2pBlock& block, ByteView pdu,
                                        PlcMemory& memory) const {
  constexpr std::size_t exception_size = 2,
                        echo_size = 5;  // function; exception code, or address and count or value
  const Byte function = sent_.at(0);
  if (pdu[0] == (function | exception_bit))
    return pdu.size() == exception_size ? p2p::p2p_error::nak : p2p::p2p_error::length;
  if (pdu[0] != function) return p2p::p2p_error::driver;
  if (writes(block)) {
    if (pdu.size() != echo_size) return p2p::p2p_error::length;
    return std::ranges::equal(pdu, ByteView(sent_).first(echo_size)) ? p2p::p2p_error::none
                                                                     : p2p::p2p_error::driver;
  }
  const unsigned count = block.elements();
  const std::size_t expected = block.type == 'X' ? (count + 7) / 8 : std::size_t{2} * count;
  if (pdu.size() != 2 + expected || pdu[1] != expected) return p2p::p2p_error::length;
  write_values(block.variables.front().own, count, pdu.subspan(2), memory);
  return p2p::p2p_error::none;
}

}  // namespace

std::unique_ptr<p2p::P2pDriver> make_modbus_p2p_driver(ModbusMode mode, Duration gap) {
  return std::make_unique<ModbusP2pDriver>(mode, gap);
}

}  // namespace fieldproof::modbus
