// Device names: "%MW100", "%MX0010A", "%LX8192" (flat on XEC), "%IW0.0.0", "%DB2468" (Cnet
// EN 7.1.4, Cnet KO 7.1.3).
//
//   element   index                                    XBM, XBC              XEC
//   X bit     word * 16 + bit                          %MX0010A: M10 bit A   %MX170: M10 bit A
//   X of T, C number of the contact                    %TX0123: contact 123  -
//   B byte    word * 2, even = low byte                %DB2468: low byte of D1234
//   W word    word
//   D dword   word / 2; word 2n is the low half
//   L lword   word / 4; word 4n is the lowest quarter
//
// U of XBM and XBC is flat, 32 words a slot: U03.07 is %UW103. Letters are accepted in either case
// (7.1.3 Note).
#pragma once

#include <cstdint>
#include <string_view>

#include "src/plc/model.hpp"

namespace fieldproof::plc {

/// What is wrong with a name, in the order in which it is looked at (DECISIONS.md
/// cnet/order-of-checks).
enum class AddressFault { none, percent, area, type, form, range };

struct DeviceAddress {
  std::uint8_t area = 0;    // position in PlcModel::areas
  char type = 0;            // X B W D L
  bool contact = false;     // X of T or C
  std::uint32_t index = 0;  // in elements of the type

  DeviceAddress operator+(std::uint32_t elements) const {
    return {area, type, contact, index + elements};
  }
  bool operator==(const DeviceAddress&) const = default;
};

/// `address.area` holds once the area letter was right (fault none, type, form, range),
/// `address.type` once the type letter was (none, form, range).
struct ParsedAddress {
  AddressFault fault = AddressFault::none;
  DeviceAddress address;

  explicit operator bool() const { return fault == AddressFault::none; }
};

/// Never fails: `fault` names the first stage that does not pass. D has no bits (Cnet EN 7.1.4,
/// Note), but for services that take them there.
ParsedAddress parse_address(const PlcModel& model, std::string_view name, bool bits_of_d = false);

/// Bytes of one element on the wire: X 1, B 1, W 2, D 4, L 8; 0 for any other letter. Either letter
/// case.
constexpr unsigned type_bytes(char type) {
  switch (type) {
    case 'X':
    case 'x':
    case 'B':
    case 'b': return 1;
    case 'W':
    case 'w': return 2;
    case 'D':
    case 'd': return 4;
    case 'L':
    case 'l': return 8;
    default: return 0;
  }
}

/// How many elements of a type the area holds; X of T and C: contacts.
std::uint32_t element_count(const DeviceArea& area, char type);

/// Are `count` elements from `address` on inside its area?
bool fits(const PlcModel& model, const DeviceAddress& address, std::uint32_t count = 1);

/// "it does not begin with %", for messages.
std::string_view describe(AddressFault fault);

}  // namespace fieldproof::plc
