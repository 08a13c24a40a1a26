#include "harness/cli/probe_found.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "harness/bench/benches.hpp"
#include "harness/bench/device_set_up.hpp"
#include "harness/bench/files/profile.hpp"
#include "harness/cli/commands.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/paths.hpp"
#include "harness/probe/target.hpp"
#include "harness/run/run_report.hpp"

namespace fieldproof::cli {

using endpoints::EndpointName;

namespace {

/// A profile that speaks the protocol and binds nothing that the manuals leave open, of the
/// protocol's first model where there is one; else that model. Programs that test this bench are no
/// modules.
std::string profile_of_a_module(const harness::Protocol& protocol) {
  const std::string first = protocol.models().front();
  const std::filesystem::path folder = harness::find_data().profiles;
  for (const std::string& name : bench::profile_names(folder)) {
    const Result<bench::Profile> one = bench::load_profile(name, folder);
    if (one && !one->peer && !one->decisions.all && one->model == first &&
        std::ranges::count(one->protocols, protocol.name()) > 0)
      return name;
  }
  return first;
}

}  // namespace

Status tell_what_to_be(endpoints::Endpoint& device, const EndpointName& name,
                       const harness::Protocol& protocol, const std::string& profile) {
  if (!endpoints::kind_of(name).started_by_bench()) return ok();
  bench::Profile declared;
  Result<bench::Profile> loaded = bench::load_profile(
      profile.empty() ? profile_of_a_module(protocol) : profile, harness::find_data().profiles);
  if (!loaded && !profile.empty()) return loaded.error();
  if (loaded) declared = std::move(*loaded);
  nlohmann::json own = declared.config;
  if (name.options.contains("station")) own["station"] = name.option("station", "");
  return device.begin(
      bench::whole_config(declared, vectors::config_station(own, 1).value_or(1), protocol));
}

std::string probe_run_line(const EndpointName& endpoint, const probe::Trial& device,
                           bool settable) {
  const ProbedDevice found = probed_device(endpoint, device, settable);
  const std::string line = "fieldproof run --endpoint " + run::shell_word(found.endpoint);
  return probe::is_emulator(endpoint) ? line : line + " --profile " + found.profile;
}

ProbedDevice probed_device(const EndpointName& endpoint, const probe::Trial& device,
                           bool settable) {
  const EndpointName name = probe::name_of_found(endpoint, device, settable);
  const std::string profile = probe::is_emulator(endpoint) && !endpoint.target.empty()
                                  ? endpoint.target
                                  : profile_of_a_module(*device.protocol);
  return {probe::to_string(name), std::string(device.protocol->name()), profile};
}

int print_probed_fingerprint(const EndpointName& endpoint, const probe::Trial& device,
                             bool settable, Duration patience) {
  EndpointName name = probe::name_of_found(endpoint, device, settable);
  name.options["protocol"] = device.protocol->name();
  bench::BenchOptions options;
  options.station = device.station;
  options.profile.response_max = patience;
  Result<bench::Benches> port = bench::Benches::open(name, {device.protocol}, options);
  if (!port) return run::complain(port.error().message, run::exit_code::trouble);
  const Result<bench::Fingerprint> found = port->fingerprint();
  if (!found)
    return run::complain(found.error().message, found.error().interrupted
                                                    ? run::exit_code::interrupted
                                                    : run::exit_code::trouble);
  run::tell(fmt::format("{:<13} {}\n", "fingerprint", bench::to_string(*found)));
  return run::exit_code::ok;
}

}  // namespace fieldproof::cli
