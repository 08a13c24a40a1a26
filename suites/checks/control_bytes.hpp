// Control characters of the serial protocols as people read them. Shares no code with the emulator.
#pragma once

#include <string>
#include <string_view>

#include "src/base/bytes.hpp"

namespace fieldproof::checks {

constexpr Byte enq = 0x05, ack = 0x06, nak = 0x15, eot = 0x04, etx = 0x03;

/// Does a frame begin with it?
bool is_header(Byte b);
/// "ENQ (request)", "ACK", "NAK"; of another byte, that it is none of them.
std::string_view header_name(Byte b);

/// A piece of a frame in ASCII; control and high bytes as <05>.
std::string printable(ByteView bytes);

}  // namespace fieldproof::checks
