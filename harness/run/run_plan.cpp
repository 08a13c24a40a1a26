#include "harness/run/run_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <filesystem>

#include "harness/bench/files/bench_file.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/set_up/command_marks.hpp"
#include "harness/explore/derived.hpp"
#include "harness/paths.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/line_matrix.hpp"
#include "harness/run/tool_vectors.hpp"
#include "harness/system/stable_name.hpp"
#include "reports/results/sha256.hpp"
#include "reports/results/shard.hpp"
#include "src/base/duration.hpp"

namespace fieldproof::run {

using endpoints::EndpointName;
using harness::DataPaths;
using harness::Protocol;
using vectors::Case;

namespace {

namespace fs = std::filesystem;

safety::WordReader words_of(const harness::Protocols& known) {
  return [known](std::string_view text) { return known.read_word(text); };
}

bool is_emulated(const EndpointName& endpoint) { return endpoints::kind_of(endpoint).emulated; }

/// A model without a profile of its own: what a user-defined frame file describes.
bool is_bare_model(const EndpointName& endpoint, const DataPaths& data,
                   const harness::Protocols& known) {
  if (endpoint.target.empty() || fs::exists(data.profiles / (endpoint.target + ".json")))
    return false;
  const Result<const Protocol*> protocol =
      known.choose(endpoint.option("protocol", ""), endpoint.target);
  return protocol && (*protocol)->has_model(endpoint.target);
}

/// A definition that cannot be read is the user's mistake, not trouble of the bench.
Status check_definition(const EndpointName& endpoint, const DataPaths& data,
                        const harness::Protocols& known) {
  if (!is_emulated(endpoint) || !is_bare_model(endpoint, data, known)) return ok();
  const Result<const Protocol*> protocol =
      known.choose(endpoint.option("protocol", ""), endpoint.target);
  if (!protocol) return protocol.error();
  const auto device = (*protocol)->make_device(endpoint.target, nlohmann::json::object());
  return device ? ok() : Status(device.error());
}

/// The tool's own cases are for the definitions that come with it; others name theirs, or none.
Status check_cases_of_definition(const EndpointName& endpoint, const RunOptions& options,
                                 const std::string& model, const std::vector<const Case*>& selected,
                                 const harness::Protocols& known) {
  const auto is_for_it = [&](const Case* one) {
    const Protocol* protocol = known.find(one->protocol);
    const bool open = one->models.empty() && !options.vectors.empty();
    return protocol && protocol->has_model(endpoint.target) &&
           (open || std::ranges::find(one->models, model) != one->models.end());
  };
  if (selected.empty() || std::ranges::any_of(selected, is_for_it)) return ok();
  return fail(
      fmt::format("cannot run on {}:{}: no selected case is for '{}'; write cases for it, with "
                  "\"models\": [\"{}\"], and give --vectors FILE (vectors/README.md)",
                  endpoint.kind, endpoint.target, model, model));
}

Status check_protocols(const bench::Profile& profile, const harness::Protocols& known) {
  for (const std::string& name : profile.protocols)
    if (const Result<const Protocol*> one = known.choose(name, ""); !one)
      return fail(fmt::format("cannot use profile {}: {}", profile.name, one.error().message));
  return ok();
}

/// A model that no case is for selects nothing of what it should.
Status check_model(const bench::Profile& profile, const harness::Protocols& known) {
  if (profile.model.empty() || !profile.notes.empty()) return ok();
  for (const std::string& name : profile.protocols)
    if (const Protocol* protocol = known.find(name); protocol && protocol->has_model(profile.model))
      return ok();
  const Result<const Protocol*> any = known.choose("", profile.model);
  return fail(
      fmt::format("cannot use profile {}: no case is for the model '{}'{}; correct it, or write in "
                  "\"notes\" why",
                  profile.name, profile.model, any ? "" : " (" + any.error().message + ")"));
}

/// The model that an endpoint emulates is its profile; a real device has one of its own.
std::string profile_for(const RunOptions& options, const EndpointName& endpoint,
                        const DataPaths& data, const harness::Protocols& known) {
  if (!options.profile.empty()) return options.profile;
  if (is_emulated(endpoint))
    return endpoint.target.empty() || is_bare_model(endpoint, data, known) ? "emulator"
                                                                           : endpoint.target;
  if (endpoints::CommandMarks(endpoint.target).takes("model")) return "emulator";
  const std::string first = known.front().models().front();
  complain(
      fmt::format("no --profile given: judged as {}, whose every decision binds; a real module "
                  "wants a profile of its own: --profile takes a file, or a name in {}",
                  first, data.profiles.string()),
      0);
  return first;
}

std::string replay_command(const RunOptions& options) {
  std::string command = "fieldproof run --endpoint " + shell_word(options.endpoint);
  if (!options.profile.empty()) command += " --profile " + shell_word(options.profile);
  if (!options.vectors.empty()) command += " --vectors " + shell_word(options.vectors);
  for (const std::string& range : options.allow_write)
    command += " --allow-write " + shell_word(range);
  for (const std::string& axes : options.allow_motion)
    command += " --allow-motion " + shell_word(axes);
  if (options.derived) command += " --derived";
  if (options.read_only) command += " --read-only";
  if (!options.protocol.empty()) command += " --protocol " + shell_word(options.protocol);
  if (!options.journal.empty()) command += " --journal " + shell_word(options.journal);
  if (!options.power_cycle.empty()) command += " --power-cycle " + shell_word(options.power_cycle);
  if (!options.stimulus.empty()) command += " --stimulus " + shell_word(options.stimulus);
  if (!options.control.empty()) command += " --control " + shell_word(options.control);
  if (!options.aux.empty()) command += " --aux " + shell_word(options.aux);
  if (!options.floor.empty()) command += " --floor " + shell_word(options.floor);
  if (!options.loop.empty()) command += " --loop " + shell_word(options.loop);
  if (!options.reconfigure.empty()) command += " --reconfigure " + shell_word(options.reconfigure);
  if (options.strict) command += " --strict";
  if (options.fail_on_marginal) command += " --fail-on marginal";
  return command + " --filter ";
}

/// What the endpoint says, else what the profile declares, else 1.
Result<int> station_of(const EndpointName& endpoint, const bench::Profile& profile) {
  nlohmann::json config = profile.config;
  const bool named = endpoint.options.contains("station");
  if (named) config["station"] = endpoint.option("station", "");
  if (const std::optional<int> number = vectors::config_station(config, 1)) return *number;
  return fail(fmt::format("{}station {} is not a number from 0 to 255",
                          named ? "" : fmt::format("cannot use profile {}: config.", profile.name),
                          config["station"].dump()));
}

Result<bench::BenchOptions> bench_options(const RunOptions& options, const EndpointName& endpoint,
                                          const std::string& profile_name, const DataPaths& data,
                                          const harness::Protocols& known) {
  bench::BenchOptions bench;
  Result<bench::Profile> profile = bench::load_profile(profile_name, data.profiles);
  if (!profile) return profile.error();
  bench.profile = std::move(*profile);
  for (const auto& check : {check_protocols, check_model})
    if (const Status right = check(bench.profile, known); !right) return right.error();
  if (is_emulated(endpoint) && bench.profile.model.empty())
    bench.profile.model = fs::path(endpoint.target).stem();
  for (const std::string& range : options.allow_write) {
    if (range.empty()) return fail("--allow-write needs a range: M0-M199, D or all");
    if (Status allowed = bench.fence.allow(range, words_of(known)); !allowed)
      return allowed.error();
  }
  if (endpoints::kind_of(endpoint).started_by_bench() && options.allow_write.empty() &&
      !options.read_only)
    bench.fence.allow_everything();
  for (const std::string& axes : options.allow_motion)
    if (Status allowed = bench.fence.allow_motion(axes, known.last_axis()); !allowed)
      return allowed.error();
  const Result<int> station = station_of(endpoint, bench.profile);
  if (!station) return station.error();
  bench.station = *station;
  bench.power_cycle_command = options.power_cycle;
  bench.max_restarts = options.max_restarts;
  bench.replay = replay_command(options);
  return bench;
}

/// What the bench file says of the device `dut` (empty: there is no bench file), where no option
/// says otherwise. Endpoint, station and line go together.
Result<RunOptions> with_bench_device(RunOptions options, const std::string& dut, DutPlan& plan) {
  if (!dut.empty()) {
    const Result<bench::BenchFile> file =
        bench::load_bench_file(options.bench, words_of(plan.known));
    if (!file) return file.error();
    const Result<bench::BenchDevice> device = bench::find_device(*file, dut);
    if (!device) return device.error();
    if (options.endpoint.empty()) {
      options.endpoint = bench::endpoint_of(*device);
      plan.line = device->line;
    }
    if (options.profile.empty()) options.profile = device->profile;
    if (options.allow_write.empty() && !options.read_only)
      options.allow_write = device->allow_write;
    if (options.stimulus.empty()) options.stimulus = device->stimulus;
    if (options.control.empty()) options.control = device->control;
    if (options.aux.empty()) options.aux = device->aux;
    plan.identity = device->identity;
  }
  if (options.endpoint.empty()) options.endpoint = "emulator:";
  return options;
}

/// The options of timing: floor, line matrix, soak.
Status read_timing_options(const RunOptions& options, RunPlan& plan) {
  for (const auto& [name, given] : {std::pair{"--matrix", !options.matrix.empty()},
                                    {"--duration", !options.duration.empty()},
                                    {"--loop", !options.loop.empty()}})
    if (given && !plan.others.empty())
      return fail(fmt::format("{} is of one device; give one --dut", name));
  if (!options.wait_port.empty()) {
    const Result<Duration> wait = parse_duration(options.wait_port);
    if (!wait) return fail("--wait-port: " + wait.error().message);
    plan.wait_port = *wait;
  }
  if (!options.floor.empty()) {
    const Result<Duration> floor = parse_duration(options.floor);
    if (!floor) return fail("--floor: " + floor.error().message);
    plan.floor = bench::AdapterFloor{bench::AdapterFloor::Source::by_hand, *floor};
  }
  if (!options.loop.empty()) {
    if (plan.floor)
      return fail("--floor and --loop exclude each other: the floor is given, or it is measured");
    const Result<EndpointName> loop = endpoints::parse_endpoint(options.loop);
    if (!loop) return fail("--loop: " + loop.error().message);
    for (const Protocol* protocol : plan.protocols)
      if (const Status right = endpoints::check_options(*loop, *protocol); !right)
        return fail("--loop: " + right.error().message);
    plan.loop = *loop;
  }
  if (!options.matrix.empty()) {
    Result<std::vector<line::LineSettings>> steps = parse_line_matrix(options.matrix);
    if (!steps) return steps.error();
    plan.matrix = std::move(*steps);
    if (!is_emulated(plan.endpoint) && options.reconfigure.empty() && !isatty(STDIN_FILENO))
      return fail(
          "--matrix needs somebody who sets the device at each step: run it in a terminal, or give "
          "--reconfigure COMMAND");
  } else if (!options.reconfigure.empty()) {
    return fail("--reconfigure belongs to --matrix; give both");
  }
  if (!options.duration.empty()) {
    const Result<Duration> duration = parse_duration(options.duration);
    if (!duration) return fail("--duration: " + duration.error().message);
    if (*duration == 0ns) return fail("--duration: a soak of no time runs nothing");
    if (!options.matrix.empty() || options.repeat > 1)
      return fail("--duration excludes --matrix and --repeat: it repeats until the time is over");
    plan.soak = *duration;
  }
  return ok();
}

/// What a qualification sheet speaks of.
Status hash_files(const fs::path& vectors, const std::string& profile, const DataPaths& data,
                  std::map<std::string, std::string>& hashes) {
  const std::pair<std::string, fs::path> files[] = {
      {"tool", harness::own_executable()},
      {"vectors", vectors},
      {"profile " + profile, bench::profile_path(profile, data.profiles)},
      {"profiles folder", data.profiles}};  // what a profile extends
  for (const auto& [name, path] : files) {
    Result<std::string> hash = results::sha256_of_tree(path);
    if (!hash) return hash.error();
    hashes[name] = std::move(*hash);
  }
  return ok();
}

/// Of all the cases; empty where they are of several.
std::string only_protocol(const std::vector<const Case*>& selected) {
  if (selected.empty()) return {};
  const std::string& name = selected.front()->protocol;
  const bool all =
      std::ranges::all_of(selected, [&](const Case* one) { return one->protocol == name; });
  return all ? name : std::string();
}

/// The option `protocol`; else what the profile declares: of an emulator all that cases are
/// selected of, else the one that they are all of, else the first.
Result<std::vector<const Protocol*>> protocols_of(const DutPlan& plan,
                                                  const std::vector<const Case*>& selected) {
  std::vector<std::string> names = plan.bench.profile.protocols;
  const auto is_selected = [&](const std::string& name) {
    return std::ranges::any_of(selected, [&](const Case* one) { return one->protocol == name; });
  };
  std::string first = plan.endpoint.option("protocol", names.empty() ? "" : names.front());
  if (!plan.endpoint.options.contains("protocol"))
    if (const std::string only = only_protocol(selected);
        std::ranges::find(names, only) != names.end())
      first = only;
  if (is_emulated(plan.endpoint) && !plan.endpoint.options.contains("protocol"))
    std::erase_if(names, [&](const std::string& name) {
      const Protocol* protocol = plan.known.find(name);
      return !is_selected(name) || (protocol && !plan.endpoint.target.empty() &&
                                    !protocol->has_model(plan.endpoint.target));
    });
  else
    names = {first};
  if (names.empty()) names = {first};
  const std::string& model =
      is_emulated(plan.endpoint) ? plan.endpoint.target : plan.bench.profile.model;
  std::vector<const Protocol*> protocols;
  Status fits = ok();
  for (const std::string& name : names) {
    const Result<const Protocol*> protocol = plan.known.choose(name, model);
    if (!protocol)
      return fail(fmt::format("cannot run on {}:{}: {}", plan.endpoint.kind, plan.endpoint.target,
                              protocol.error().message));
    const Protocol& spoken = endpoints::spoken_over(plan.endpoint, **protocol);
    const Status one = endpoints::check_endpoint(plan.endpoint, spoken);
    if (one)
      protocols.push_back(&spoken);
    else
      fits = one;
  }
  // Of several, those that this way does not carry are for another one.
  if (protocols.empty()) return fits.error();
  return protocols;
}

/// What is wrong with options of the endpoint or with the configuration that the profile declares
/// is said before anything is opened.
Status check_declared(const DutPlan& plan) {
  const bench::Profile& profile = plan.bench.profile;
  for (const Protocol* protocol : plan.protocols) {
    if (const Status right = endpoints::check_options(plan.endpoint, *protocol); !right)
      return right;
    if (is_emulated(plan.endpoint)) continue;
    if (const auto device = protocol->configured(profile.model, profile.config); !device)
      return fail(fmt::format("cannot use profile {}: {}", profile.name, device.error().message));
  }
  return ok();
}

/// Devices that share a run have a journal each.
std::string journal_path(const RunOptions& options, const std::string& dut) {
  fs::path path = options.journal.empty() ? fs::path(options.out) / "journal.ndjson"
                                          : fs::path(options.journal);
  if (options.duts.size() > 1)
    path.replace_filename(path.stem().string() + "-" + dut + path.extension().string());
  return path.string();
}

/// A second port of the device; or, of a protocol that is carried, the PLC that is its partner: the
/// first of its stations.
safety::JournalDevice aux_device(const RunOptions& options, const EndpointName& name, int station,
                                 const DutPlan& plan) {
  const bench::Profile& profile = plan.bench.profile;
  const Protocol* const own = plan.known.find(plan.protocols.front()->name());
  if (!own || own->has_frames())
    return {options.aux, station, name.option("protocol", std::string(plan.known.front().name())),
            profile.model, profile.config};
  const nlohmann::json stations = profile.config.value("stations", nlohmann::json::array());
  const nlohmann::json partner =
      stations.is_array() && !stations.empty() ? stations.front() : nlohmann::json::object();
  return {options.aux, station, std::string(own->name()), partner.value("model", profile.model),
          partner};
}

/// A port beside the device's.
Status plan_aux(const RunOptions& options, DutPlan& plan) {
  Result<EndpointName> aux = endpoints::parse_endpoint(options.aux);
  if (!aux) return aux.error();
  const std::optional<int> station =
      vectors::config_station({{"station", aux->option("station", "1")}}, 1);
  if (!station)
    return fail(
        fmt::format("station '{}' is not a number from 0 to 255", aux->option("station", "1")));
  plan.bench.aux_device = aux_device(options, *aux, *station, plan);
  const Result<const Protocol*> protocol = plan.known.choose(plan.bench.aux_device.protocol, "");
  if (!protocol) return protocol.error();
  const Status right = endpoints::check_options(*aux, endpoints::spoken_over(*aux, **protocol));
  if (right) plan.aux = std::move(*aux);
  return right;
}

/// `profile` becomes the name of the device's profile.
Result<DutPlan> make_dut_plan(const RunOptions& given, const harness::Protocols& known,
                              const std::string& dut, const std::vector<const Case*>& selected,
                              std::string& profile) {
  DutPlan plan;
  plan.known = known;
  const DataPaths data = harness::find_data();
  const Result<RunOptions> options = with_bench_device(given, dut, plan);
  if (!options) return options.error();
  Result<EndpointName> endpoint = endpoints::parse_endpoint(options->endpoint);
  if (!endpoint) return endpoint.error();
  plan.endpoint = std::move(*endpoint);
  if (!options->protocol.empty()) {
    const std::string there = plan.endpoint.option("protocol", options->protocol);
    if (there != options->protocol)
      return fail(fmt::format("--protocol {}: the endpoint says {}; leave one of the two",
                              options->protocol, there));
    plan.endpoint.options["protocol"] = options->protocol;
  }
  if (const std::string stable =
          endpoints::kind_of(plan.endpoint).local_port ? os::stable_name(plan.endpoint.target) : "";
      !stable.empty())
    complain(fmt::format("{} may be another adapter next time; its stable name is {}",
                         plan.endpoint.target, stable),
             0);
  profile = profile_for(*options, plan.endpoint, data, known);
  Result<bench::BenchOptions> bench = bench_options(*options, plan.endpoint, profile, data, known);
  if (!bench) return bench.error();
  plan.bench = std::move(*bench);
  if (const Status made = check_definition(plan.endpoint, data, known); !made) return made.error();
  if (is_emulated(plan.endpoint) && is_bare_model(plan.endpoint, data, known))
    if (const Status any = check_cases_of_definition(plan.endpoint, *options,
                                                     plan.bench.profile.model, selected, known);
        !any)
      return any.error();
  plan.bench.known = known;
  plan.ends_with_run = endpoints::kind_of(plan.endpoint).started_by_bench();
  plan.writes_all = plan.ends_with_run && options->allow_write.empty() && !options->read_only;
  plan.bench.device = {options->endpoint, plan.bench.station, "", plan.bench.profile.model,
                       plan.bench.profile.config};
  if (!is_emulated(plan.endpoint) && !plan.bench.fence.empty())
    plan.journal = journal_path(*options, dut);
  Result<std::vector<const Protocol*>> spoken = protocols_of(plan, selected);
  if (!spoken) return spoken.error();
  plan.protocols = std::move(*spoken);
  if (const Status right = check_declared(plan); !right) return right.error();
  if (std::ranges::all_of(selected, [](const Case* one) { return vectors::is_client_case(*one); }))
    plan.bench.client_cases = selected;
  else if (endpoints::kind_of(plan.endpoint).listens)
    return fail(
        fmt::format("cannot run on {}:{}: there the device connects to the bench, which is "
                    "for cases of clients alone; add --role client",
                    plan.endpoint.kind, plan.endpoint.target));
  plan.stimulus = options->stimulus;
  plan.control = options->control;
  if (plan.control == "-" && !plan.ends_with_run)
    return fail(
        "--control -: the bench has not started this device; give --control a command, or start "
        "the device by exec:");
  if (!options->aux.empty())
    if (const Status right = plan_aux(*options, plan); !right)
      return fail("--aux: " + right.error().message);
  if (const Status checked =
          bench::check_fingerprint(plan.identity.fingerprint, *plan.protocols.front());
      !checked)
    return fail(fmt::format("cannot use bench file {}: devices.{}: {}", given.bench, dut,
                            checked.error().message));
  return plan;
}

/// Devices that share the cases must be alike for them: which one takes a case is chance.
Status check_alike(const DutPlan& first, const DutPlan& other,
                   const std::vector<bench::Waiver>& waivers) {
  const auto differ = [&](const std::string& what, const std::string& a, const std::string& b) {
    return fail(
        fmt::format("cannot share the cases between {} and {}: {} {} and {}; run them apart",
                    first.identity.name, other.identity.name, what, a, b));
  };
  const std::string& a = first.bench.profile.name;
  const std::string& b = other.bench.profile.name;
  if (a != b) return differ("their profiles are", a, b);
  if (first.protocols != other.protocols)
    return differ("they speak", std::string(first.protocols.front()->name()),
                  std::string(other.protocols.front()->name()));
  const bool by_firmware = std::ranges::any_of(waivers, [](const bench::Waiver& one) {
    return !one.firmware_from.empty() || !one.firmware_to.empty();
  });
  if (by_firmware && first.identity.firmware != other.identity.firmware)
    return differ("waivers ask for the firmware, which is", first.identity.firmware,
                  other.identity.firmware);
  return ok();
}

/// A real line takes a second for each silence: there a few of each derivation are enough.
Status derive(const RunOptions& options, const harness::Protocols& known, vectors::VectorSet& set) {
  constexpr std::size_t few = 6;
  const Result<EndpointName> endpoint =
      endpoints::parse_endpoint(options.endpoint.empty() ? "emulator:" : options.endpoint);
  // A bench file's device may be on any line.
  const bool all = options.duts.empty() && endpoint && endpoints::kind_of(*endpoint).simulated;
  Result<std::vector<Case>> derived = explore::derived_cases(
      set.cases, known, all ? 0 : few, static_cast<std::uint64_t>(std::max(0, options.seed)),
      [&](const std::string& id) { return vectors::matches_filter(id, options.filter); });
  if (!derived) return fail("--derived: " + derived.error().message);
  std::ranges::move(*derived, std::back_inserter(set.cases));
  return ok();
}

/// "model=XBL-C41A" stands for all devices of the bench file whose identity says so.
Result<RunOptions> with_duts_by_name(RunOptions options, const harness::Protocols& known) {
  std::vector<std::string> names;
  for (const std::string& dut : options.duts) {
    if (options.bench.empty() || dut.find('=') == dut.npos) {
      names.push_back(dut);
      continue;
    }
    const Result<bench::BenchFile> file = bench::load_bench_file(options.bench, words_of(known));
    if (!file) return file.error();
    const Result<std::vector<std::string>> found = bench::find_devices(*file, dut);
    if (!found) return found.error();
    for (const std::string& name : *found)
      if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  options.duts = std::move(names);
  return options;
}

Status check_duts(const RunOptions& options) {
  if (options.bench.empty() != options.duts.empty())
    return fail("--bench FILE and --dut NAME go together; give both");
  if (options.duts.size() > 1 && !options.endpoint.empty())
    return fail("--endpoint names one port, --dut several; leave --endpoint out");
  for (const std::string& dut : options.duts) {
    if (dut.empty()) return fail("--dut needs the name of a device");
    if (std::ranges::count(options.duts, dut) > 1)
      return fail(fmt::format("--dut {} is given twice; leave one", dut));
  }
  return ok();
}

/// What a run looks at, besides the cases that it selects.
std::string loaded_filter(const RunOptions& options, const std::vector<bench::Waiver>& waivers) {
  if (!waivers.empty()) return {};  // they may name any case
  // What is derived stands in the folder of what it is derived from.
  return options.derived ? vectors::folders_of_filter(options.filter) : options.filter;
}

/// Speed and frame are those of a line: what runs on a network would be the same at each step.
Status leave_networks_out(const harness::Protocols& known, RunPlan& plan) {
  const std::size_t all = plan.selected.size();
  std::erase_if(plan.selected, [&](const Case* one) {
    const Protocol* protocol = known.find(one->protocol);
    return protocol && protocol->on_network();
  });
  plan.without_line = all - plan.selected.size();
  if (plan.without_line == 0 || !plan.selected.empty()) return ok();
  return fail(
      "--matrix sets speed and frame of a line, and each selected case runs on a network; select "
      "others with --filter or --protocol, or leave --matrix out");
}

}  // namespace

Result<RunPlan> make_run_plan(const RunOptions& given, const harness::Protocols& known) {
  RunPlan plan;
  if (const Status shard = results::check_shard_environment(); !shard) return shard.error();
  const Result<RunOptions> named = with_duts_by_name(given, known);
  if (!named) return named.error();
  const RunOptions& options = *named;
  if (const Status duts = check_duts(options); !duts) return duts.error();
  if (options.read_only && !options.allow_write.empty())
    return fail("--read-only and --allow-write exclude each other; give one");
  Result<std::vector<bench::Waiver>> waivers = bench::load_waivers(options.waivers);
  if (!waivers) return waivers.error();
  plan.waivers = std::move(*waivers);
  Result<vectors::VectorSet> loaded =
      load_sound_vectors(options.vectors, known, loaded_filter(options, plan.waivers));
  if (!loaded) return loaded.error();
  plan.vectors = std::move(*loaded);
  if (options.derived)
    if (const Status derived = derive(options, known, plan.vectors); !derived)
      return derived.error();
  for (const Case& one : plan.vectors.cases)
    if (vectors::matches_filter(one.id, options.filter) && vectors::has_role(one, options.role))
      plan.selected.push_back(&one);
  if (!options.matrix.empty())
    if (const Status left = leave_networks_out(known, plan); !left) return left.error();
  std::string profile;
  Result<DutPlan> first = make_dut_plan(
      options, known, options.duts.empty() ? "" : options.duts.front(), plan.selected, profile);
  if (!first) return first.error();
  static_cast<DutPlan&>(plan) = std::move(*first);
  if (const Status exist = check_decisions(plan.bench.profile, plan.vectors); !exist)
    return exist.error();
  for (std::size_t i = 1; i < options.duts.size(); ++i) {
    Result<DutPlan> other = make_dut_plan(options, known, options.duts[i], plan.selected, profile);
    if (!other) return other.error();
    if (const Status alike = check_alike(plan, *other, plan.waivers); !alike) return alike.error();
    plan.others.push_back(std::move(*other));
  }
  if (const Status read = read_timing_options(options, plan); !read) return read.error();
  if (const std::vector<std::string> lost =
          bench::unknown_targets(plan.waivers, case_ids(plan.vectors));
      !lost.empty())
    return fail(fmt::format("cannot use waivers {}: {}; remove or correct them", options.waivers,
                            fmt::join(lost, ", ")));
  if (options.qualify)
    if (const Status hashed =
            hash_files(vectors_path(options.vectors), profile, harness::find_data(), plan.hashes);
        !hashed)
      return hashed.error();
  return plan;
}

}  // namespace fieldproof::run
