#include "harness/run/exit_code.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string_view>

#include "harness/system/terminal.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::run {

std::string shell_word(const std::string& word) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

int complain(const std::string& message, int code) {
  const auto columns = static_cast<std::size_t>(os::terminal_columns(STDERR_FILENO));
  fmt::print(stderr, "{}\n", text::fold("fieldproof: " + message, columns));
  return code;
}

}  // namespace fieldproof::run
