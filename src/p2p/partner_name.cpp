#include "src/p2p/partner_name.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/base/bytes.hpp"
#include "src/base/letters.hpp"

namespace fieldproof::p2p {

namespace {

bool is_name(std::string_view name, std::size_t longest) {
  const auto is_index = [](char c) { return hex_digit(c) >= 0 || c == '.'; };
  return name.size() >= 4 && name.size() <= longest && name[0] == '%' &&
         plc::type_bytes(name[2]) != 0 && std::ranges::all_of(name.substr(3), is_index);
}

}  // namespace

Status check_partner_names(const P2pBlock& block, std::size_t longest) {
  const char* key = block.function == P2pBlock::Function::write ? "save" : "read";
  for (const P2pVariable& variable : block.variables) {
    const std::string& name = variable.partner;
    if (!is_name(name, longest))
      return fail(fmt::format("{} '{}' is no device name of the partner; give one such as %MW100",
                              key, name));
    if (upper(name[2]) != block.type)
      return fail(fmt::format("{} '{}' is not of the block's type; its type letter is {}", key,
                              name, block.type));
  }
  return ok();
}

std::string unpadded_name(std::string_view name) {
  if (name.size() < 4 || name.find('.') != std::string_view::npos) return std::string(name);
  const std::size_t digit = std::min(name.find_first_not_of('0', 3), name.size() - 1);
  return std::string(name.substr(0, 3)) + std::string(name.substr(digit));
}

}  // namespace fieldproof::p2p
