#include "harness/run/exit_code.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "harness/system/terminal.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::run {

int complain(const std::string& message, int code) {
  const auto columns = static_cast<std::size_t>(os::terminal_columns(STDERR_FILENO));
  fmt::print(stderr, "{}\n", text::fold("fieldproof: " + message, columns));
  return code;
}

}  // namespace fieldproof::run
