// Device memory through Modbus with the default bases: bits and words of M are written and read (function codes 01, 03,
// 0F, 10), those of P, on XEC I, are read (02, 04). No other area has a data address there.
#pragma once

#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "suites/modbus/framing.hpp"

namespace fieldproof::modbus {

/// Few enough words a request for a frame of 255 characters (PROTOCOLS.md, ASCII), and any server.
/// Bit names of M are those of XBC and XBM, word and bit digit.
/// Errors say why there is no way.
Result<std::vector<Bytes>> write_requests(const Framing& framing, int station, std::string_view address, std::string_view hex);
Result<std::vector<Bytes>> read_requests(const Framing& framing, int station, std::string_view address, std::size_t digits);

/// Anything but an exception: its form is for the cases to judge.
Status write_reply(const Framing& framing, ByteView reply);
Result<std::string> read_reply(const Framing& framing, ByteView reply);

/// What the messages in a request would write.
std::vector<Protocol::Written> written_by(const Framing& framing, ByteView request);

}  // namespace fieldproof::modbus
