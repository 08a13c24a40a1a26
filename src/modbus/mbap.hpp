// The frame of Modbus TCP (FEnet EN 5.3.2, 5.3.3): MBAP header and PDU, numbers high byte first.
//
//   transaction (2)  protocol (2)  length (2)  unit (1)  PDU
//
// `length` counts the bytes behind it: unit and PDU. Table 5-10 calls it 'frame size except MBAP'
// and counts the unit neither there nor here; every device counts it. There is no check: TCP has
// one. Protocol 0 is Modbus.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "src/base/bytes.hpp"

namespace fieldproof::modbus {

/// Transaction, protocol and length: as much as must have come to know where the frame ends.
constexpr std::size_t mbap_prefix = 6;
/// A length of 1 has no function; above 260 the stream cannot be followed (decision: between the
/// 254 that the longest PDU needs and this, the frame is read, and refused).
constexpr unsigned mbap_least_length = 2, mbap_most_length = 260;

struct MbapHeader {
  std::uint16_t transaction = 0;
  std::uint16_t protocol = 0;
  std::uint16_t length = 0;

  bool length_is_possible() const {
    return length >= mbap_least_length && length <= mbap_most_length;
  }
  /// Of the whole frame.
  std::size_t frame_size() const { return mbap_prefix + length; }
};

/// Nothing while fewer than mbap_prefix bytes have come.
std::optional<MbapHeader> read_mbap(ByteView bytes);

/// Of protocol 0.
Bytes encode_mbap(std::uint16_t transaction, Byte unit, ByteView pdu);

}  // namespace fieldproof::modbus
