#include "src/modbus/mbap.hpp"

#include "src/modbus/pdu.hpp"

namespace fieldproof::modbus {

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
