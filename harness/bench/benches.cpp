#include "harness/bench/benches.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/bench/device_set_up.hpp"
#include "harness/bench/fewest_starts.hpp"

namespace fieldproof::bench {

using nlohmann::json;

Result<Benches> Benches::open(const endpoints::EndpointName& name,
                              const std::vector<const harness::Protocol*>& protocols,
                              const BenchOptions& options) {
  Benches benches;
  for (const harness::Protocol* protocol : protocols) {
    endpoints::EndpointName own = name;
    own.options["protocol"] = protocol->name();
    Result<std::unique_ptr<endpoints::Endpoint>> endpoint =
        endpoints::open_endpoint(own, *protocol);
    if (!endpoint) return endpoint.error();
    if ((options.control || options.endpoint_is_control) && (*endpoint)->capabilities().real_device)
      *endpoint =
          std::make_unique<endpoints::Controlled>(std::move(*endpoint), *protocol, options.control);
    Member member{protocol, std::move(*endpoint), options,
                  std::make_shared<Standing>(options.max_restarts)};
    member.options.device.protocol = protocol->name();
    Result<SetUp> declared = make_set_up(member, json::object(), member.options);
    if (!declared)
      return fail("cannot use profile " + options.profile.name + ": " + declared.error().message);
    member.set_ups.emplace("{}", std::move(*declared));
    benches.members_.push_back(std::move(member));
  }
  return benches;
}

namespace {

/// Those of a device that is declared so, and needed otherwise.
BenchOptions set_up_options(const json& needed, BenchOptions options) {
  options.profile.config.update(needed);
  options.profile.config.erase("model");
  options.profile.model = needed.value("model", options.profile.model);
  options.station = needed.value("station", options.station);
  if (!needed.empty()) {
    options.device.station = options.station;
    options.device.model = options.profile.model;
    options.device.config = options.profile.config;
  }
  return options;
}

}  // namespace

Result<Benches::SetUp> Benches::make_set_up(const Member& member, const json& needed,
                                            const BenchOptions& declared) {
  BenchOptions options = set_up_options(needed, declared);
  SetUp set_up;
  if (member.endpoint->capabilities().real_device) {
    Result<std::unique_ptr<harness::Protocol>> configured =
        member.protocol->configured(options.profile.model, options.profile.config);
    if (!configured) return configured.error();
    set_up.configured = std::move(*configured);
  }
  set_up.bench = std::make_unique<Bench>(*member.endpoint,
                                         set_up.configured ? *set_up.configured : *member.protocol,
                                         std::move(options), member.known);
  return set_up;
}

json Benches::needed_by(const vectors::Case& source, const Member& member) {
  const BenchOptions& declared = member.options;
  if (!member.endpoint->capabilities().real_device) return json::object();
  return needed_set_up(source, declared.profile, declared.station, *member.endpoint,
                       *member.protocol);
}

/// What no device of this profile can be set up as is for the declared one, which says why not.
Bench& Benches::bench_for(const vectors::Case& source) {
  Member& member = members_[index_for(source)];
  const json needed = needed_by(source, member);
  const std::string key = needed.dump();
  if (!member.set_ups.contains(key)) {
    Result<SetUp> made = make_set_up(member, needed, member.options);
    if (!made) return member.bench();
    member.set_ups.emplace(key, std::move(*made));
  }
  member.last = member.set_ups.at(key).bench.get();
  return *member.last;
}

std::vector<const vectors::Case*> Benches::grouped(
    const std::vector<const vectors::Case*>& cases) const {
  if (!members_.front().endpoint->capabilities().real_device) return cases;
  return fewest_starts(cases, [this](const vectors::Case& source) {
    const Member& member = member_for(source);
    const json needed = needed_by(source, member);
    return SetUpOfCase{started_with(source, member, needed), needed.dump(),
                       source.fresh && could_each_run({&source}).front()};
  });
}

/// What the device is started with for it.
std::string Benches::started_with(const vectors::Case& source, const Member& member,
                                  const json& needed) {
  const BenchOptions options = set_up_options(needed, member.options);
  json config = whole_config(options.profile, options.station, *member.protocol);
  if (source.config.contains("role")) config["role"] = source.config["role"];
  return member.endpoint->started_with(config);
}

Status Benches::start() {
  for (Member& member : members_) {
    if (!member.bench().stopped().empty()) continue;
    if (Status alive = member.bench().start(); !alive) return alive;
  }
  return ok();
}

Status Benches::still_answers() {
  const auto as_it_is = [](const Member& member) {
    return member.last ? member.last->start() : member.bench().start();
  };
  for (Member& member : members_) {
    if (!member.bench().stopped().empty()) continue;
    Status alive = as_it_is(member);
    // The last case may have set it up so that it answers nobody.
    if (!alive && !alive.error().interrupted) alive = member.bench().start();
    if (!alive) return alive;
  }
  return ok();
}

std::optional<exchange::Channel> Benches::silent_line() const {
  for (const Member& member : members_)
    if (std::optional<exchange::Channel> asked = member.bench().silent_line()) return asked;
  return std::nullopt;
}

std::size_t Benches::index_for(const vectors::Case& source) const {
  const auto own = std::ranges::find_if(
      members_, [&](const Member& member) { return member.protocol->name() == source.protocol; });
  return own == members_.end() ? 0 : static_cast<std::size_t>(own - members_.begin());
}

results::CaseResult Benches::run(const vectors::Case& source) {
  return bench_for(source).run(source);
}

std::optional<results::CaseResult> Benches::run_ahead(const vectors::Case& source) {
  return bench_for(source).run_ahead(source);
}

results::CaseResult Benches::conclude(const vectors::Case& source,
                                      std::optional<results::CaseResult> ahead) {
  Bench& bench = bench_for(source);
  if (!ahead || !bench.stopped().empty()) return bench.run(source);
  bench.conclude(*ahead);
  return std::move(*ahead);
}

std::vector<bool> Benches::which_could_run(const std::vector<const vectors::Case*>& cases,
                                           const BenchOptions* options) const {
  std::vector<bool> could;
  std::map<std::string, Result<SetUp>> others;
  for (const vectors::Case* one : cases) {
    const Member& member = member_for(*one);
    const json needed = needed_by(*one, member);
    const std::string key = fmt::format("{}{}", member.protocol->name(), needed.dump());
    if (!others.contains(key))
      others.emplace(key, make_set_up(member, needed, options ? *options : member.options));
    const Result<SetUp>& other = others.at(key);
    could.push_back(other && other->bench->could_run(*one));
  }
  return could;
}

std::vector<bool> Benches::could_each_run(const std::vector<const vectors::Case*>& cases) const {
  return which_could_run(cases, nullptr);
}

std::size_t Benches::could_run(const std::vector<const vectors::Case*>& cases,
                               const BenchOptions& options) const {
  return static_cast<std::size_t>(std::ranges::count(which_could_run(cases, &options), true));
}

std::pair<const harness::Protocol*, std::vector<harness::Protocol::Written>> Benches::written_by(
    const vectors::Case& source) const {
  const Member& member = member_for(source);
  return {member.protocol, member.bench().written_by(source)};
}

Result<std::string> Benches::measure_floor() {
  std::string text;
  for (Member& member : members_) {
    Result<std::optional<AdapterFloor>> measured = member.bench().measure_floor();
    if (!measured) return measured.error();
    if (!*measured) continue;
    member.bench().use_floor(**measured);
    std::string own = to_string(**measured, member.bench().floor());
    const endpoints::Capabilities& can = member.endpoint->capabilities();
    if (const std::string held =
            can.shared ? held_by_server(**measured, can.round_trip) : std::string();
        !held.empty())
      own += "; " + held;
    text += members_.size() == 1
                ? own
                : (text.empty() ? "" : "; ") + std::string(member.protocol->name()) + ' ' + own;
  }
  if (!text.empty()) text += members_.front().bench().driver_silence();
  return text;
}

std::string Benches::use_floor(const AdapterFloor& floor) {
  for (Member& member : members_) member.bench().use_floor(floor);
  const Bench& bench = members_.front().bench();
  return to_string(floor, bench.floor()) + bench.driver_silence();
}

Status Benches::start_those_that_answer() {
  for (Member& member : members_) {
    const Status alive = member.bench().start();
    if (alive) continue;
    if (alive.error().interrupted || member.bench().port_failed()) return alive;
    member.bench().set_aside(alive.error().message);
  }
  return ok();
}

std::string Benches::stopped() const {
  const auto can_run = [](const Member& member) { return member.bench().stopped().empty(); };
  return members_.empty() || std::ranges::any_of(members_, can_run)
             ? ""
             : members_.front().bench().stopped();
}

std::vector<results::CaseResult> Benches::set_up_findings() const {
  std::vector<results::CaseResult> all;
  for (const Member& member : members_)
    std::ranges::move(member.bench().set_up_findings().results(), std::back_inserter(all));
  return all;
}

std::string Benches::put_back() {
  std::string open;
  for (Member& member : members_) {
    for (auto& [key, set_up] : member.set_ups)
      if (const std::string one = set_up.bench->put_back(); !one.empty())
        open += (open.empty() ? "" : ", ") + one;
    if (const std::string one = member.bench().leave_as_declared(); !one.empty())
      open += (open.empty() ? "" : ", ") + one;
  }
  return open;
}

std::string Benches::doubtful_writes() const {
  std::string all;
  for (const Member& member : members_)
    for (const auto& [key, set_up] : member.set_ups)
      if (const std::string one = set_up.bench->doubtful_writes(); !one.empty())
        all += (all.empty() ? "" : "; ") + one;
  return all;
}

bool Benches::interrupted() const {
  return std::ranges::any_of(members_,
                             [](const Member& member) { return member.bench().interrupted(); });
}

std::string Benches::protocol_names() const {
  std::string names;
  for (const Member& member : members_)
    names += (names.empty() ? "" : ", ") + std::string(member.protocol->name());
  return names;
}

}  // namespace fieldproof::bench
