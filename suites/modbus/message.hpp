// What the frames of RTU, ASCII and TCP have in common: station, function code and data, without
// start, check and end. Shares no code with the emulator (src/modbus): what is shown to be wrong
// must not depend on what answers.
#pragma once

#include <string>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::modbus_suite {

/// A named part of a message, in bytes of the message.
struct Part {
  std::string name;  // "byte count"
  std::size_t at = 0;
  std::size_t size = 0;
  std::string text;
  std::string problem;
};

/// High byte first; both bytes must be there.
inline unsigned word_at(ByteView bytes, std::size_t at) { return bytes[at] * 256u + bytes[at + 1]; }

/// Appends it, high byte first.
void put_word(Bytes& message, std::size_t value);
/// Two hex digits a byte, without spaces.
std::string digits(ByteView bytes);

/// Who sends a message, where it is known.
enum class Way { unknown, request, reply };

/// The parts of a request, reply or exception (Cnet EN 9.4) as far as it can be read. Which one it
/// is, where `way` is unknown, is told by what fits its length: a reply where the byte count
/// agrees, else a request. The parts cover the message.
std::vector<Part> message_parts(ByteView message, Way way = Way::unknown);

/// The lengths that a message which begins like `bytes` can have, replies before requests; empty
/// where the function code tells none.
std::vector<std::size_t> message_lengths(ByteView bytes);

/// Can a whole message be a request, or else a reply? A single write is both.
bool can_be(ByteView message, bool request);

}  // namespace fieldproof::modbus_suite
