// Which faults of our broken devices `explore` finds.
#include <exception>

#include "suites/broken/exploring.hpp"
#include "suites/faults/kits.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::faults {

namespace {

bool finds(const broken::Exploring& exploring, const Kit& kit, std::optional<std::size_t> fault,
           std::uint64_t most) {
  try {
    return exploring.finds([&](const vectors::Case& one) { return kit.run(fault, one); }, most);
  } catch (const std::exception&) {
    return fault.has_value();  // the device is beside itself, as a crash would show
  }
}

}  // namespace

std::vector<bool> found_by_exploring(const Kit& kit, const std::vector<vectors::Case>& cases,
                                     std::uint64_t requests) {
  std::vector<bool> found(kit.faults.size());
  const harness::Protocol* protocol = suites::protocols().find(kit.name);
  if (!protocol) return found;
  const auto exploring = broken::Exploring::of(*protocol, cases);
  if (!exploring || finds(*exploring, kit, std::nullopt, requests / 4)) return found;
  for (std::size_t i = 0; i < kit.faults.size(); ++i)
    found[i] = finds(*exploring, kit, i, requests);
  return found;
}

}  // namespace fieldproof::faults
