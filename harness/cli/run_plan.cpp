#include "harness/cli/run_plan.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>

#include "harness/bench/bench_file.hpp"
#include "harness/cli/tool_vectors.hpp"
#include "harness/paths.hpp"
#include "harness/results/sha256.hpp"

namespace fieldproof {

namespace {

namespace fs = std::filesystem;

bool is_emulated(const EndpointName& endpoint) { return endpoint.kind == "emulator" || endpoint.kind == "pty"; }

/// A model without a profile of its own: what a user-defined frame file describes.
bool is_bare_model(const EndpointName& endpoint, const DataPaths& data) {
  if (endpoint.target.empty() || fs::exists(data.profiles / (endpoint.target + ".json"))) return false;
  const Result<const Protocol*> protocol = choose_protocol(endpoint.option("protocol", ""), endpoint.target);
  return protocol && (*protocol)->has_model(endpoint.target);
}

/// The model that an endpoint emulates is its profile; a real device has one of its own.
std::string profile_for(const RunOptions& options, const EndpointName& endpoint, const DataPaths& data) {
  if (!options.profile.empty()) return options.profile;
  if (is_emulated(endpoint)) return endpoint.target.empty() || is_bare_model(endpoint, data) ? "emulator" : endpoint.target;
  complain("no --profile given: judged as xbc-h, whose every decision binds; a real module wants a profile of its own, such as xbc-dxxxh", 0);
  return "xbc-h";
}

std::string replay_command(const RunOptions& options) {
  std::string command = "fieldproof run --endpoint " + shell_word(options.endpoint);
  if (!options.profile.empty()) command += " --profile " + shell_word(options.profile);
  if (!options.vectors.empty()) command += " --vectors " + shell_word(options.vectors);
  for (const std::string& range : options.allow_write) command += " --allow-write " + shell_word(range);
  if (!options.journal.empty()) command += " --journal " + shell_word(options.journal);
  if (!options.power_cycle.empty()) command += " --power-cycle " + shell_word(options.power_cycle);
  if (options.floor_ms > 0) command += fmt::format(" --floor {:g}", options.floor_ms);
  if (options.strict) command += " --strict";
  if (options.fail_on_marginal) command += " --fail-on marginal";
  return command + " --filter ";
}

Result<BenchOptions> bench_options(const RunOptions& options, const EndpointName& endpoint, const std::string& profile_name, const DataPaths& data) {
  BenchOptions bench;
  Result<Profile> profile = load_profile(profile_name, data.profiles);
  if (!profile) return profile.error();
  bench.profile = std::move(*profile);
  if (is_emulated(endpoint) && bench.profile.model.empty()) bench.profile.model = fs::path(endpoint.target).stem();
  if (options.floor_ms > 0) bench.profile.floor = Duration(static_cast<Duration::rep>(options.floor_ms * 1e6));
  for (const std::string& range : options.allow_write)
    if (Status allowed = bench.fence.allow(range); !allowed) return allowed.error();
  nlohmann::json station{{"station", endpoint.option("station", "1")}};
  const std::optional<int> number = config_station(station, 1);
  if (!number) return fail(fmt::format("station '{}' is not a number from 0 to 255", endpoint.option("station", "1")));
  bench.station = *number;
  bench.power_cycle_command = options.power_cycle;
  bench.replay = replay_command(options);
  return bench;
}

/// What the bench file says of the device, where no option says otherwise. Endpoint, station and line go together.
Result<RunOptions> with_bench_device(RunOptions options, RunPlan& plan) {
  if (options.bench.empty() != options.dut.empty()) return fail("--bench FILE and --dut NAME go together; give both");
  if (!options.bench.empty()) {
    const Result<BenchFile> file = load_bench_file(options.bench);
    if (!file) return file.error();
    const Result<BenchDevice> device = find_device(*file, options.dut);
    if (!device) return device.error();
    if (options.endpoint.empty()) {
      options.endpoint = endpoint_of(*device);
      plan.line = device->line;
    }
    if (options.profile.empty()) options.profile = device->profile;
    if (options.allow_write.empty()) options.allow_write = device->allow_write;
    plan.identity = device->identity;
  }
  if (options.endpoint.empty()) options.endpoint = "emulator:";
  return options;
}

/// What a qualification sheet speaks of.
Status hash_files(const fs::path& vectors, const std::string& profile, const DataPaths& data, std::map<std::string, std::string>& hashes) {
  const std::pair<std::string, fs::path> files[] = {{"tool", own_executable()},
                                                    {"vectors", vectors},
                                                    {"profile " + profile, profile_path(profile, data.profiles)},
                                                    {"profiles folder", data.profiles}};  // what a profile extends
  for (const auto& [name, path] : files) {
    Result<std::string> hash = sha256_of_tree(path);
    if (!hash) return hash.error();
    hashes[name] = std::move(*hash);
  }
  return ok();
}

/// The option `protocol`; else what the profile declares: of an emulator all that cases are selected of, else the first.
Result<std::vector<const Protocol*>> protocols_of(const RunPlan& plan) {
  std::vector<std::string> names = plan.bench.profile.protocols;
  const auto is_selected = [&](const std::string& name) {
    return std::ranges::any_of(plan.selected, [&](const Case* one) { return one->protocol == name; });
  };
  const std::string first = plan.endpoint.option("protocol", names.empty() ? "" : names.front());
  if (is_emulated(plan.endpoint) && !plan.endpoint.options.contains("protocol")) std::erase_if(names, std::not_fn(is_selected));
  else names = {first};
  if (names.empty()) names = {first};
  const std::string& model = is_emulated(plan.endpoint) ? plan.endpoint.target : plan.bench.profile.model;
  std::vector<const Protocol*> protocols;
  for (const std::string& name : names) {
    const Result<const Protocol*> protocol = choose_protocol(name, model);
    if (!protocol) return fail(fmt::format("cannot run on {}:{}: {}", plan.endpoint.kind, plan.endpoint.target, protocol.error().message));
    protocols.push_back(*protocol);
  }
  return protocols;
}

}  // namespace

Result<RunPlan> make_run_plan(const RunOptions& given) {
  RunPlan plan;
  const DataPaths data = find_data();
  const Result<RunOptions> complete = with_bench_device(given, plan);
  if (!complete) return complete.error();
  const RunOptions& options = *complete;
  Result<EndpointName> endpoint = parse_endpoint(options.endpoint);
  if (!endpoint) return endpoint.error();
  plan.endpoint = std::move(*endpoint);
  const std::string profile = profile_for(options, plan.endpoint, data);
  Result<BenchOptions> bench = bench_options(options, plan.endpoint, profile, data);
  if (!bench) return bench.error();
  plan.bench = std::move(*bench);
  plan.bench.device = {options.endpoint, plan.bench.station, "", plan.bench.profile.model, plan.bench.profile.config};
  if (!is_emulated(plan.endpoint) && !plan.bench.fence.empty())
    plan.journal = options.journal.empty() ? (fs::path(options.out) / "journal.ndjson").string() : options.journal;
  Result<std::vector<Waiver>> waivers = load_waivers(options.waivers);
  if (!waivers) return waivers.error();
  plan.waivers = std::move(*waivers);
  Result<VectorSet> loaded = load_sound_vectors(options.vectors);
  if (!loaded) return loaded.error();
  plan.vectors = std::move(*loaded);
  for (const Case& one : plan.vectors.cases)
    if (matches_filter(one.id, options.filter)) plan.selected.push_back(&one);
  Result<std::vector<const Protocol*>> spoken = protocols_of(plan);
  if (!spoken) return spoken.error();
  plan.protocols = std::move(*spoken);
  if (const std::vector<std::string> lost = unknown_targets(plan.waivers, case_ids(plan.vectors)); !lost.empty())
    return fail(fmt::format("cannot use waivers {}: {}; remove or correct them", options.waivers, fmt::join(lost, ", ")));
  if (options.qualify)
    if (const Status hashed = hash_files(vectors_path(options.vectors), profile, data, plan.hashes); !hashed) return hashed.error();
  return plan;
}

}  // namespace fieldproof
