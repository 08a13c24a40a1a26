#include "src/modbus/frame.hpp"

#include <algorithm>
#include <optional>

#include "src/modbus/checks.hpp"
#include "src/modbus/mbap.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {

namespace {
constexpr Byte colon = ':', cr = '\r', lf = '\n';

/// Station, function and data without the check.
ModbusFrame opened(ByteView content) {
  if (content.size() < 2) return {plc::service_status::not_modbus};
  return {plc::service_status::normal, content[0], Bytes(content.begin() + 1, content.end())};
}

ModbusFrame decode_rtu(ByteView frame) {
  constexpr std::size_t crc_size = 2;
  if (frame.size() < crc_size) return {plc::service_status::not_modbus};
  const ByteView content = frame.first(frame.size() - crc_size), crc = frame.last(crc_size);
  if (modbus_crc(content) != (crc[0] | crc[1] << 8)) return {plc::service_status::not_modbus};
  return opened(content);
}

ModbusFrame decode_ascii(ByteView frame) {
  if (frame.size() < 3 || frame[0] != colon || frame[frame.size() - 2] != cr ||
      frame.back() != lf) {
    return {plc::service_status::not_modbus};
  }
  const ByteView digits = frame.subspan(1, frame.size() - 3);
  if (std::ranges::any_of(digits, [](Byte b) { return hex_digit(static_cast<char>(b)) < 0; }))
    return {plc::service_status::not_hex};
  const std::optional<Bytes> bytes = from_hex(to_text(digits));
  if (!bytes) return {plc::service_status::not_hex};
  if (bytes->empty() || modbus_lrc(*bytes) != 0)
    return {plc::service_status::not_modbus};  // with its LRC the sum is 0
  return opened(ByteView(*bytes).first(bytes->size() - 1));
}

ModbusFrame decode_tcp(ByteView frame) {
  const std::optional<MbapHeader> header = read_mbap(frame);
  if (!header || header->protocol != 0 || header->frame_size() != frame.size())
    return {plc::service_status::not_modbus};
  ModbusFrame decoded = opened(frame.subspan(mbap_prefix));
  decoded.transaction = header->transaction;
  return decoded;
}
}  // namespace

ModbusFrame decode_modbus_frame(ModbusMode mode, ByteView frame) {
  switch (mode) {
    case ModbusMode::rtu: return decode_rtu(frame);
    case ModbusMode::ascii: return decode_ascii(frame);
    case ModbusMode::tcp: break;
  }
  return decode_tcp(frame);
}

Bytes encode_modbus_frame(ModbusMode mode, Byte station, ByteView pdu, std::uint16_t transaction) {
  if (mode == ModbusMode::tcp) return encode_mbap(transaction, station, pdu);
  Bytes content{station};
  content.insert(content.end(), pdu.begin(), pdu.end());
  if (mode == ModbusMode::rtu) {
    const std::uint16_t crc = modbus_crc(content);
    content.push_back(static_cast<Byte>(crc));
    content.push_back(static_cast<Byte>(crc >> 8));
    return content;
  }
  content.push_back(modbus_lrc(content));
  Bytes frame{colon};
  frame.reserve(1 + 2 * content.size() + 2);
  for (const Byte b : content) {
    frame.push_back(static_cast<Byte>(hex_char(b >> 4)));
    frame.push_back(static_cast<Byte>(hex_char(b)));
  }
  frame.push_back(cr);
  frame.push_back(lf);
  return frame;
}

}  // namespace fieldproof::modbus
