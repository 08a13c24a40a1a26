#include "src/plc/counters.hpp"

#include <fmt/format.h>

#include <array>

#include "src/base/bytes.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::plc {

std::string counter_text(std::uint32_t value, std::size_t digits, std::size_t least) {
  std::size_t size = digits == 0 ? least : digits;
  while (size < 8 && value >> (4 * size) != 0) ++size;
  return hex_number(value, static_cast<int>(size));
}

Result<std::string> get_counter(const ServiceCounters& counters, std::string_view name,
                                std::size_t digits) {
  if (name == "@status") return counter_text(counters.status, digits, 2);
  if (name == "@errors") return counter_text(counters.errors, digits);
  if (name == "@services") return counter_text(counters.services, digits);
  constexpr std::array<std::string_view, 3> names{"@status", "@errors", "@services"};
  return fail(
      fmt::format("cannot get {}: there is no such counter; use @status, @errors or @services{}",
                  name, suggestion(name, names)));
}

}  // namespace fieldproof::plc
