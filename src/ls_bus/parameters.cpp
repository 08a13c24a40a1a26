#include "src/ls_bus/parameters.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::ls_bus {

namespace {
constexpr std::array<ParameterRange, 5> ranges{{
    {0x0000, 0x0003, false},
    {0x0004, 0x0008, true},
    {0x0009, 0x000F, false},
    {0x0010, 0x0FFF, true},
    {0x1200, 0x12FF, true},  // 1230 is the manual's example
}};

const ParameterRange* range_of(unsigned address) {
  const auto found = std::ranges::find_if(
      ranges, [=](const ParameterRange& r) { return r.first <= address && address <= r.last; });
  return found == ranges.end() ? nullptr : &*found;
}

template <typename Condition>
bool all(unsigned first, unsigned count, Condition holds) {
  for (unsigned i = 0; i < count; ++i)
    if (!holds(range_of(first + i))) return false;
  return true;
}
}  // namespace

std::span<const ParameterRange> inverter_ranges() { return ranges; }

bool InverterParameters::exist(unsigned first, unsigned count) const {
  return all(first, count, [](const ParameterRange* range) { return range != nullptr; });
}

bool InverterParameters::writable(unsigned first, unsigned count) const {
  return all(first, count, [](const ParameterRange* range) { return range && range->write; });
}

}  // namespace fieldproof::ls_bus
