// One Modbus frame: station and PDU, with the framing of its mode (Cnet EN and KO 9.3, FEnet
// EN 5.3).
//
//   RTU    station, PDU, CRC low byte, CRC high byte
//   ASCII  ':', station, PDU and LRC as two hex digits a byte, CR LF; replies in upper case,
//   requests in either
//   TCP    MBAP header, whose unit is the station, and PDU (mbap.hpp)
#pragma once

#include <cstddef>
#include <cstdint>

#include "src/base/bytes.hpp"
#include "src/modbus/modbus_mode.hpp"

namespace fieldproof::modbus {

/// The longest frame: 253 bytes of PDU. RTU: station and CRC; ASCII: ':', station, LRC, CR LF.
constexpr std::size_t modbus_max_pdu = 253;
constexpr std::size_t rtu_max_frame = 1 + modbus_max_pdu + 2;
constexpr std::size_t ascii_max_frame = 1 + 2 * (1 + modbus_max_pdu + 1) + 2;

struct ModbusFrame {
  /// service_status (src/plc/counters.hpp): normal, or why it is none. not_modbus: too short
  /// (station, function and check), wrong check, no ':' or CR LF. not_hex: a character that is no
  /// hex digit, or an odd number of digits. TCP: not_modbus also for another protocol.
  std::uint16_t fault = 0;
  Byte station = 0;
  Bytes pdu{};
  std::uint16_t transaction = 0;  // TCP
};

/// A frame as a receiver found it (receiver.hpp).
ModbusFrame decode_modbus_frame(ModbusMode mode, ByteView frame);

/// Adds the check and, in ASCII, head and tail; TCP: the header.
Bytes encode_modbus_frame(ModbusMode mode, Byte station, ByteView pdu,
                          std::uint16_t transaction = 0);

}  // namespace fieldproof::modbus
