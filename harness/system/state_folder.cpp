#include "harness/system/state_folder.hpp"

#include <cstdlib>

namespace fieldproof::os {

std::filesystem::path state_folder(std::string_view name) {
  const std::filesystem::path ours = std::filesystem::path("fieldproof") / name;
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state && *state == '/') return state / ours;
  if (home && *home == '/') return std::filesystem::path(home) / ".local/state" / ours;
  return {};
}

}  // namespace fieldproof::os
