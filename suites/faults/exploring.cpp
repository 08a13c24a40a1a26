// Which faults of our broken devices `explore` finds.
#include <exception>
#include <nlohmann/json.hpp>

#include "harness/explore/explorer.hpp"
#include "suites/faults/kits.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::faults {

namespace {

bool finds(const Kit& kit, std::optional<std::size_t> fault, const harness::Protocol& protocol,
           const harness::Protocol& configured, const std::string& model,
           const std::vector<explore::Request>& requests, std::uint64_t most) {
  Result<explore::Oracle> oracle = explore::Oracle::open(protocol, model, 1);
  if (!oracle) return false;
  const auto run = [&](const vectors::Case& one) { return kit.run(fault, one); };
  explore::Explorer explorer({&configured, 1, false, run, {}}, std::move(*oracle), requests, 1);
  try {
    while (explorer.requests_sent() < most && explorer.findings().empty()) explorer.step();
  } catch (const std::exception&) {
    return fault.has_value();  // the device is beside itself, as a crash would show
  }
  return !explorer.findings().empty();
}

}  // namespace

std::vector<bool> found_by_exploring(const Kit& kit, const std::vector<vectors::Case>& cases,
                                     std::uint64_t requests) {
  std::vector<bool> found(kit.faults.size());
  const harness::Protocol* protocol = suites::protocols().find(kit.name);
  if (!protocol) return found;
  const std::string model = protocol->models().front();
  const auto configured = protocol->configured(model, nlohmann::json::object());
  if (!configured) return found;
  const harness::Protocol& own = *configured ? **configured : *protocol;
  const std::vector<explore::Request> seeds = explore::requests_of(cases, *protocol, model);
  if (seeds.empty() || finds(kit, std::nullopt, *protocol, own, model, seeds, requests / 4))
    return found;
  for (std::size_t i = 0; i < kit.faults.size(); ++i)
    found[i] = finds(kit, i, *protocol, own, model, seeds, requests);
  return found;
}

}  // namespace fieldproof::faults
