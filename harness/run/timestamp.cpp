#include "harness/run/timestamp.hpp"

#include <ctime>

namespace fieldproof::run {

std::string timestamp() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S%z", std::localtime(&now));
  std::string stamp(text);
  return stamp.insert(stamp.size() - 2, ":");  // ISO 8601 writes +01:00
}

}  // namespace fieldproof::run
