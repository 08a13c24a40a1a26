#include "reports/compare/merge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <cstdlib>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "reports/results/shard.hpp"

namespace fieldproof::compare {

using results::DutInfo;
using results::RunInfo;
using results::Shard;

namespace {

std::string property(const RunInfo& run, const std::string& name) {
  const auto found = run.properties.find(name);
  return found == run.properties.end() ? "" : found->second;
}

std::optional<Shard> shard_of(const ResultFile& file) {
  return results::parse_shard(property(file.run, "shard"));
}

std::string or_none(const std::string& text) { return text.empty() ? "none" : text; }

std::string hashes_text(const RunInfo& run) {
  std::string text;
  for (const auto& [name, hash] : run.hashes)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, hash);
  return text;
}

/// What must be alike for the parts to be parts of one run.
Status check_alike(const ResultFile& first, const ResultFile& other) {
  const auto shards = [](const ResultFile& file) {
    const std::optional<Shard> shard = shard_of(file);
    return shard ? std::to_string(shard->total) : "";
  };
  const std::tuple<const char*, std::string, std::string, const char*> alike[] = {
      {"vectors", first.run.vectors_hash, other.run.vectors_hash,
       "run all parts with the same vectors"},
      {"tool version", first.run.tool_version, other.run.tool_version,
       "run all parts with the same tool"},
      {"profile", first.run.profile, other.run.profile, "run all parts with the same --profile"},
      {"gate", property(first.run, "gate"), property(other.run, "gate"),
       "give all parts the same --strict, --fail-on and --qualify"},
      {"hashed files", hashes_text(first.run), hashes_text(other.run),
       "run all parts with the same files"},
      {"shards", shards(first), shards(other), "give the shards of one run"},
      {"selection", property(first.run, "selection"), property(other.run, "selection"),
       "run all shards with the same --filter"},
      {"repeat", property(first.run, "repeat"), property(other.run, "repeat"),
       "run all shards with the same --repeat"},
  };
  for (const auto& [what, a, b, advice] : alike)
    if (a != b)
      return fail(fmt::format("cannot merge {} with {}: the {} differ{}: {} and {}; {}", other.path,
                              first.path, what, std::string_view(what).ends_with('s') ? "" : "s",
                              or_none(b), or_none(a), advice));
  return ok();
}

Status check_files(const std::vector<ResultFile>& files) {
  std::map<Shard, std::string> seen;
  for (const ResultFile& file : files) {
    if (file.run.vectors_hash.empty())
      return fail(
          fmt::format("cannot merge {}: it does not say which vectors it is of; give "
                      "results.ndjson or results.json",
                      file.path));
    if (const Status alike = check_alike(files.front(), file); !alike) return alike;
    const std::optional<Shard> shard = shard_of(file);
    if (!shard) continue;
    const auto [twin, is_new] = seen.emplace(*shard, file.path);
    if (!is_new)
      return fail(fmt::format("cannot merge {} with {}: both are shard {}; leave one", file.path,
                              twin->second, results::to_string(*shard)));
  }
  return ok();
}

/// "a" where all have it, "a, b" where they differ.
void join(std::string& text, const std::string& more) {
  if (text.empty())
    text = more;
  else if (!more.empty() &&
           fmt::format(", {}, ", text).find(fmt::format(", {}, ", more)) == std::string::npos)
    text += ", " + more;
}

DutInfo device_of(const RunInfo& run) {
  DutInfo dut{run.endpoint, {}, run.identity};
  for (const char* name : {"station", "line"})
    if (const std::string value = property(run, name); !value.empty()) dut.properties[name] = value;
  return dut;
}

bool same_device(const DutInfo& a, const DutInfo& b) {
  return a.endpoint == b.endpoint && a.identity.name == b.identity.name &&
         a.identity.serial == b.identity.serial;
}

void add_device(std::vector<DutInfo>& duts, const DutInfo& one) {
  if (std::ranges::none_of(duts, [&](const DutInfo& known) { return same_device(known, one); }))
    duts.push_back(one);
}

/// The devices of all files, where a bench file names several.
std::vector<DutInfo> devices_of(const std::vector<ResultFile>& files) {
  std::vector<DutInfo> duts;
  for (const ResultFile& file : files) {
    for (const DutInfo& dut : file.run.duts) add_device(duts, dut);
    if (file.run.duts.empty() && !file.run.identity.name.empty())
      add_device(duts, device_of(file.run));
  }
  return duts.size() > 1 ? duts : std::vector<DutInfo>{};
}

/// Vectors of both files that met it.
void add_erratum(std::vector<results::ErratumInfo>& errata, const results::ErratumInfo& one) {
  const auto known = std::ranges::find(errata, one.id, &results::ErratumInfo::id);
  if (known == errata.end()) return errata.push_back(one);
  for (const std::string& vector : one.vectors)
    if (std::ranges::find(known->vectors, vector) == known->vectors.end())
      known->vectors.push_back(vector);
}

RunInfo merge_heads(const std::vector<ResultFile>& files) {
  RunInfo run = files.front().run;
  std::vector<std::string> paths;
  run.errata.clear();
  for (const ResultFile& file : files) {
    paths.push_back(file.path);
    run.started = std::min(run.started, file.run.started);
    join(run.endpoint, file.run.endpoint);
    run.identity = results::in_common(run.identity, file.run.identity);
    for (const auto& [name, value] : file.run.properties) join(run.properties[name], value);
    for (const results::ErratumInfo& one : file.run.errata) add_erratum(run.errata, one);
    for (const auto& [manual, titles] : file.run.sections)
      run.sections[manual].insert(titles.begin(), titles.end());
  }
  run.duts = devices_of(files);
  if (const auto shards = run.properties.extract("shard"))
    run.properties["shards"] = shards.mapped();
  run.properties["merged"] = fmt::format("{}", fmt::join(paths, ", "));
  return run;
}

/// The results of one file; an error where another file has judged the same case otherwise.
Status add_results(
    const ResultFile& file, bool several_devices,
    std::map<std::pair<std::string, int>, std::pair<results::Verdict, std::string>>& known,
    std::vector<results::CaseResult>& results) {
  for (results::CaseResult result : file.results) {
    const auto [earlier, is_new] =
        known.emplace(std::pair(result.id, result.repeat), std::pair(result.verdict, file.path));
    if (!is_new && earlier->second.first != result.verdict)
      return fail(fmt::format(
          "cannot merge {} with {}: {} is {} in the one and {} in the other; leave one "
          "of the two, or `fieldproof compare` them",
          file.path, earlier->second.second, result.id, results::to_string(result.verdict),
          results::to_string(earlier->second.first)));
    if (!is_new) continue;
    if (several_devices && result.dut.empty()) result.dut = file.run.identity.name;
    results.push_back(std::move(result));
  }
  return ok();
}

void note_ends(const std::vector<ResultFile>& files, MergedRun& merged) {
  for (const ResultFile& file : files) {
    if (!file.end) {
      merged.troubles.push_back(
          fmt::format("{}: the run was killed after {} results", file.path, file.results.size()));
      continue;
    }
    merged.interrupted |= file.end->interrupted;
    merged.seconds = std::max(merged.seconds, file.end->seconds);
    if (!file.end->trouble.empty())
      merged.troubles.push_back(fmt::format("{}: {}", file.path, file.end->trouble));
    for (const results::Reason& reason : file.end->reasons) {
      if (reason.what == "report" || reason.what == "not-restored")
        merged.troubles.push_back(fmt::format("{}: {}", file.path, reason.message));
      if (reason.what == "baseline") join(merged.worse, reason.message);
    }
  }
}

void note_missing_shards(const std::vector<ResultFile>& files, MergedRun& merged) {
  std::set<Shard> there;
  for (const ResultFile& file : files)
    if (const std::optional<Shard> shard = shard_of(file)) there.insert(*shard);
  if (there.empty()) return;
  const int total = there.begin()->total;
  std::vector<std::string> missing;
  for (int index = 0; index < total; ++index)
    if (!there.contains({index, total})) missing.push_back(results::to_string(Shard{index, total}));
  if (!missing.empty())
    merged.troubles.push_back(fmt::format("shard{} {} {} missing", missing.size() == 1 ? "" : "s",
                                          fmt::join(missing, ", "),
                                          missing.size() == 1 ? "is" : "are"));
}

}  // namespace

Result<MergedRun> merge_results(const std::vector<ResultFile>& files) {
  if (files.empty()) return fail("nothing to merge; give the results of two or more runs");
  if (const Status fit = check_files(files); !fit) return fit.error();
  MergedRun merged;
  merged.run = merge_heads(files);
  std::map<std::pair<std::string, int>, std::pair<results::Verdict, std::string>> known;
  for (const ResultFile& file : files)
    if (const Status added = add_results(file, !merged.run.duts.empty(), known, merged.results);
        !added)
      return added.error();
  note_ends(files, merged);
  note_missing_shards(files, merged);
  return merged;
}

}  // namespace fieldproof::compare
