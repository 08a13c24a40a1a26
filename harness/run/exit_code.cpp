#include "harness/run/exit_code.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <string_view>

namespace fieldproof::run {

int complain(const std::string& message, int code) {
  fmt::print(stderr, "fieldproof: {}\n", message);
  return code;
}

}  // namespace fieldproof::run
