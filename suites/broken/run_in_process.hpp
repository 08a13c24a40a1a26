// One case against one broken device in this process, in simulated time.
#pragma once

#include <string>
#include <utility>

#include "harness/bench/bench.hpp"
#include "harness/endpoints/emulator.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::broken {

/// A profile that declares nothing but the protocol of `source`.
inline bench::Profile bare_profile(const vectors::Case& source) {
  bench::Profile profile;
  profile.name = "emulator";
  profile.protocols = {source.protocol};
  return profile;
}

/// `source` against the device that `make` makes of `model`.
inline results::CaseResult run_in_process(const vectors::Case& source, const std::string& model,
                                          endpoints::DeviceFactory make, bench::Profile profile) {
  const harness::Protocol& protocol = *suites::protocols().find(source.protocol);
  endpoints::EmulatorEndpoint endpoint({"emulator", model, {}}, std::move(make), {},
                                       protocol.default_port());
  bench::BenchOptions options;
  options.profile = std::move(profile);
  options.known = suites::protocols();
  return bench::Bench(endpoint, protocol, options).run(source);
}

/// Does the case say that something is wrong, as far as it can? What is missed of a `should` turns
/// red with --strict alone; what is only measured never does.
inline bool turns_red(const vectors::Case& one, results::Verdict verdict) {
  return verdict == results::Verdict::fail ||
         (one.level == "should" && verdict == results::Verdict::non_strict);
}

}  // namespace fieldproof::broken
