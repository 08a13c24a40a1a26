// XGT FEnet frames taken apart for people: `frame`, the field-by-field difference, the end of a
// frame (FEnet EN 5.2.3 to 5.2.6). Shares no code with the emulator (src/xgt_fenet): what is shown
// to be wrong must not depend on what answers.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"

namespace fieldproof::xgt_fenet_suite {

constexpr std::size_t header_size = 20, invoke_at = 14, length_at = 16, check_at = 19;
constexpr unsigned read_command = 0x54, write_command = 0x58, continuous_type = 0x14;

/// Low byte first; both bytes must be there.
inline unsigned word_at(ByteView bytes, std::size_t at) { return bytes[at] | bytes[at + 1] << 8; }
/// Appends it, low byte first.
void put_word(Bytes& bytes, std::size_t value);

/// Header and the bytes that its length field announces.
std::optional<std::size_t> frame_length(ByteView bytes);

/// The parts of a request, reply or refusal, as far as it can be read. They cover the frame.
std::vector<harness::Field> explain(ByteView frame);

/// Fields of these names repeat: behind the first comes "name 2" and so on.
constexpr std::string_view name_field = "name", data_field = "data", size_field = "data size",
                           count_field = "number of data";
bool is_field(const harness::Field& field, std::string_view name);

}  // namespace fieldproof::xgt_fenet_suite
