#include "src/p2p/keywords.hpp"

#include <charconv>

namespace fieldproof {

namespace {
/// Takes `digits` decimal digits off the front.
std::optional<unsigned> take_number(std::string_view& text, std::size_t digits) {
  unsigned number = 0;
  if (text.size() < digits) return std::nullopt;
  const auto [end, error] = std::from_chars(text.data(), text.data() + digits, number);
  if (error != std::errc{} || end != text.data() + digits) return std::nullopt;
  text.remove_prefix(digits);
  return number;
}

bool take_text(std::string_view& text, std::string_view expected) {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(expected.size());
  return true;
}

bool in_range(std::optional<unsigned> parameter, std::optional<unsigned> block) {
  return parameter && *parameter >= 1 && *parameter <= p2p_parameters && block && *block < p2p_blocks;
}

/// "1_NDR00"
std::optional<P2pKeyword> find_flag(const PlcModel& model, std::string_view text) {
  const auto parameter = take_number(text, 1);
  if (!take_text(text, "_") || text.size() < 2) return std::nullopt;
  const std::string_view name = text.substr(0, text.size() - 2);
  text.remove_prefix(name.size());
  const auto block = take_number(text, 2);
  if (!in_range(parameter, block)) return std::nullopt;
  const P2pResultFlags flags = p2p_result_flags(model, *parameter, *block);
  if (name == "NDR") return P2pKeyword{flags.ndr, 0};
  if (name == "ERR") return P2pKeyword{flags.err, 0};
  if (name == "STATUS") return P2pKeyword{flags.status, 1};
  if (name == "SVCCNT") return P2pKeyword{flags.services, 2};
  if (name == "ERRCNT") return P2pKeyword{flags.errors, 2};
  return std::nullopt;
}

/// "1B00RD1"
std::optional<P2pKeyword> find_register(const PlcModel& model, std::string_view text) {
  const auto parameter = take_number(text, 1);
  if (!take_text(text, "B")) return std::nullopt;
  const auto block = take_number(text, 2);
  if (!in_range(parameter, block)) return std::nullopt;
  const P2pRegisters registers = p2p_registers(model, *parameter, *block);
  if (text == "SN") return P2pKeyword{registers.station, 1};
  if (text.size() != 3 || (text[0] != 'R' && text[0] != 'W') || (text[1] != 'D' && text[1] != 'S')) return std::nullopt;
  if (text[2] < '1' || text[2] > '4') return std::nullopt;
  const P2pRegisters::Area& area = (text[0] == 'R' ? registers.read : registers.save)[static_cast<std::size_t>(text[2] - '1')];
  return text[1] == 'D' ? P2pKeyword{area.name, registers.name_words} : P2pKeyword{area.size, 1};
}
}  // namespace

std::optional<P2pKeyword> find_p2p_keyword(const PlcModel& model, std::string_view keyword) {
  if (take_text(keyword, "_P2P")) return find_flag(model, keyword);
  if (take_text(keyword, "_P")) return find_register(model, keyword);
  return std::nullopt;
}

}  // namespace fieldproof
