// Where bytes come in that anybody may have sent or written: one entry point each. Whatever they
// are, nothing crashes or hangs, and what is said of them fits them. An input that breaks a rule
// ends the process.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

struct Target {
  std::string_view name;
  std::string_view what;  // for --help
  void (*feed)(ByteView input);
  std::vector<Bytes> (*seeds)();  // good inputs, to begin with
  bool chooses = false;           // the first byte chooses the protocol (protocol_of)
};

std::span<const Target> targets();
/// nullptr: there is none of that name.
const Target* find_target(std::string_view name);

}  // namespace fieldproof::fuzz
