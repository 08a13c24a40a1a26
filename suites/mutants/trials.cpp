#include "suites/mutants/trials.hpp"

#include <algorithm>
#include <memory>

#include "harness/protocols.hpp"
#include "suites/broken/exploring.hpp"
#include "suites/broken/run_in_process.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::mutants {

namespace {

/// The model that the tool runs a case on.
std::string model_of(const vectors::Case& one) {
  if (const auto named = one.config.find("model"); named != one.config.end()) return *named;
  const std::string usual = suites::protocols().find(one.protocol)->models().front();
  const bool any = one.models.empty() || std::ranges::find(one.models, usual) != one.models.end();
  return any ? usual : one.models.front();
}

results::CaseResult run(const vectors::Case& one, const MutatedDevices& devices) {
  return broken::run_in_process(
      one, model_of(one),
      [&](std::string_view model, const nlohmann::json& config) {
        return devices.make(one.protocol, model, config);
      },
      broken::bare_profile(one));
}

bool is_red(const results::CaseResult& result) { return results::gates(result.verdict, {}); }

}  // namespace

std::vector<Trial> trials_of(const std::vector<vectors::Case>& cases) {
  std::vector<Trial> trials;
  for (const vectors::Case& one : cases)
    trials.push_back({one.id, one.protocol, one.source.manual + ", " + one.source.section,
                      [&one](const MutatedDevices& devices) { return is_red(run(one, devices)); }});
  return trials;
}

std::vector<Trial> explorations(const std::vector<vectors::Case>& cases, std::uint64_t requests) {
  std::vector<Trial> trials;
  for (const harness::Protocol* protocol : suites::protocols()) {
    std::vector<vectors::Case> own;
    std::ranges::copy_if(cases, std::back_inserter(own), [&](const vectors::Case& one) {
      return one.protocol == protocol->name();
    });
    const auto exploring = broken::Exploring::of(*protocol, own);
    if (!exploring) continue;
    const auto red = [exploring = *exploring, requests](const MutatedDevices& devices) {
      return exploring.finds([&](const vectors::Case& one) { return run(one, devices); }, requests);
    };
    const std::string name(protocol->name());
    trials.push_back({"explore " + name, name, "", red});
  }
  return trials;
}

}  // namespace fieldproof::mutants
