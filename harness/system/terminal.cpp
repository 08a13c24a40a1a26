#include "harness/system/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>
#include <algorithm>
#include <cstdlib>

namespace fieldproof::os {

namespace {

constexpr int narrowest = 20, usual = 80;

}  // namespace

int terminal_columns(int fd) {
  const char* set = std::getenv("COLUMNS");
  if (const int columns = set ? std::atoi(set) : 0; columns > 0)
    return std::max(columns, narrowest);
  if (isatty(fd) == 0) return 0;
  winsize size{};
  const bool told = ioctl(fd, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return told ? std::max<int>(size.ws_col, narrowest) : usual;
}

}  // namespace fieldproof::os
