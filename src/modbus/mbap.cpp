#include "src/modbus/mbap.hpp"

namespace fieldproof::modbus {

namespace {
std::uint16_t word_at(ByteView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

void put_word(Bytes& to, std::size_t value) {
  to.push_back(static_cast<Byte>(value >> 8));
  to.push_back(static_cast<Byte>(value));
}
}  // namespace

std::optional<MbapHeader> read_mbap(ByteView bytes) {
  if (bytes.size() < mbap_prefix) return std::nullopt;
  return MbapHeader{word_at(bytes, 0), word_at(bytes, 2), word_at(bytes, 4)};
}

Bytes encode_mbap(std::uint16_t transaction, Byte unit, ByteView pdu) {
  Bytes frame;
  frame.reserve(mbap_prefix + 1 + pdu.size());
  put_word(frame, transaction);
  put_word(frame, 0);
  put_word(frame, 1 + pdu.size());
  frame.push_back(unit);
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  return frame;
}

}  // namespace fieldproof::modbus
