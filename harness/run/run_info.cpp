#include "harness/run/run_info.hpp"

#include <fmt/format.h>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>

#include "harness/run/timestamp.hpp"
#include "harness/run/tool_vectors.hpp"
#include "harness/vectors/citations.hpp"
#include "harness/vectors/fingerprint.hpp"
#include "reports/results/shard.hpp"

namespace fieldproof::run {

namespace {

/// What the devices have in common stays in `info`, each has an entry of its own.
void name_devices(const RunPlan& plan, const std::vector<bench::Benches>& ports,
                  const std::vector<std::string>& floors, results::RunInfo& info) {
  for (std::size_t i = 0; i < ports.size(); ++i) {
    const DutPlan& own = plan.dut(i);
    results::DutInfo one{
        ports[i].describe(), {{"station", std::to_string(own.bench.station)}}, own.identity};
    if (!own.line.empty()) one.properties["line"] = own.line;
    if (i < floors.size() && !floors[i].empty()) one.properties["floor"] = floors[i];
    info.duts.push_back(std::move(one));
  }
  for (std::size_t i = 1; i < info.duts.size(); ++i) {
    info.identity = results::in_common(info.identity, info.duts[i].identity);
    info.endpoint += ", " + info.duts[i].endpoint;
  }
  info.properties.erase("station");
  info.properties.erase("line");
  info.properties.erase("floor");
}

/// Tells shards of one selection from those of another.
std::string selection(const RunPlan& plan) {
  std::uint64_t print = vectors::empty_fingerprint;
  for (const vectors::Case* one : plan.selected)
    print = vectors::extend_fingerprint(print, one->id + '\n');
  return fmt::format("{} cases, {:016x}", plan.selected.size(), print);
}

/// The mistakes of the manuals that the selected cases met.
std::vector<results::ErratumInfo> errata(const RunPlan& plan) {
  std::map<std::string_view, std::set<std::string>> vectors_of;  // by statement
  for (const vectors::Case* one : plan.selected)
    for (const std::string_view statement : vectors::cited_by(*one))
      vectors_of[statement].insert(one->vector_id);
  std::vector<results::ErratumInfo> met;
  for (const vectors::Erratum& one : plan.vectors.errata) {
    std::set<std::string> vectors;
    for (const vectors::Passage& place : one.places)
      if (const auto here = vectors_of.find(place.statement); here != vectors_of.end())
        vectors.insert(here->second.begin(), here->second.end());
    if (!vectors.empty()) met.push_back(erratum_info(one, {vectors.begin(), vectors.end()}));
  }
  return met;
}

/// What the sections are called that the selected cases cite, with those that these are in.
std::map<std::string, results::SectionTitles> sections(const RunPlan& plan) {
  std::map<std::string_view, const vectors::Statement*> by_id;
  for (const vectors::Statement& one : plan.vectors.statements) by_id[one.id] = &one;
  std::map<std::string, std::set<std::string>> cited;  // by manual
  for (const vectors::Case* one : plan.selected)
    for (const std::string_view id : vectors::cited_by(*one))
      if (const auto found = by_id.find(id); found != by_id.end())
        cited[found->second->manual].insert(found->second->section);
  std::map<std::string, results::SectionTitles> named;
  for (const auto& [manual, titles] : plan.vectors.sections)
    for (const auto& [number, title] : titles)
      if (std::ranges::any_of(cited[manual], [&](const std::string& section) {
            return results::is_within(section, number);
          }))
        named[manual][number] = title;
  return named;
}

}  // namespace

results::Gate gate_of(const RunOptions& options) {
  return {options.strict, options.fail_on_marginal, options.qualify, options.min_judged};
}

results::RunInfo run_info(const RunOptions& options, const RunPlan& plan,
                          const std::vector<bench::Benches>& ports,
                          const std::vector<std::string>& floors) {
  results::RunInfo info;
  info.tool_version = FIELDPROOF_VERSION;
  info.started = timestamp();
  info.endpoint = ports.front().describe();
  info.profile = plan.bench.profile.name;
  info.command = options.command;
  info.vectors_hash = plan.vectors.hash;
  info.properties["gate"] = text::to_string(gate_of(options));
  info.properties["station"] = std::to_string(plan.bench.station);
  info.properties["protocol"] = ports.front().protocol_names();
  if (!plan.bench.profile.notes.empty())
    info.properties["profile_notes"] = plan.bench.profile.notes;
  if (!plan.bench.profile.title.empty()) info.properties["device"] = plan.bench.profile.title;
  if (const std::size_t tables = plan.vectors.tables.size())
    info.properties["tables"] =
        fmt::format("{} facts of printed tables beside the cases, which `fieldproof lint` checks",
                    text::grouped(tables));
  if (options.seed >= 0) info.properties["seed"] = std::to_string(options.seed);
  if (options.repeat > 1) info.properties["repeat"] = std::to_string(options.repeat);
  if (!plan.line.empty()) info.properties["line"] = plan.line;
  if (!plan.matrix.empty()) info.properties["matrix"] = options.matrix;
  if (plan.without_line > 0)
    info.properties["left_out"] = fmt::format(
        "{} that run on a network, which has no line to set",
        plan.without_line == 1 ? "1 case" : text::grouped(plan.without_line) + " cases");
  if (plan.writes_all)
    info.properties["writes"] =
        "anywhere: the device ends with the run (--read-only forbids it, --allow-write narrows it)";
  if (plan.soak > 0ns) info.properties["duration"] = options.duration;
  if (!floors.empty() && !floors.front().empty()) info.properties["floor"] = floors.front();
  info.properties["response_max_ms"] = fmt::format("{:g}", to_ms(plan.bench.profile.response_max));
  info.identity = plan.identity;
  info.hashes = plan.hashes;
  if (const std::optional<results::Shard> shard = results::shard_of_environment()) {
    info.properties["shard"] = results::to_string(*shard);
    info.properties["selection"] = selection(plan);
  }
  info.errata = errata(plan);
  info.sections = sections(plan);
  if (!plan.others.empty()) name_devices(plan, ports, floors, info);
  return info;
}

}  // namespace fieldproof::run
