#include "reports/history/history.hpp"

#include <fmt/format.h>

#include <unordered_map>

#include "reports/history/device.hpp"
#include "reports/results/result_json.hpp"
#include "reports/results/sha256.hpp"

namespace fieldproof::history {

using compare::RunSummary;

namespace {

std::string json_of(const auto& value) {
  std::string text;
  results::append_json(text, value);
  return text;
}

/// The mistakes of the manuals stand in each of its reports; they are no part of its history.
std::string head_of(RunSummary run) {
  run.run.errata.clear();
  return json_of(run.run);
}

std::string names_hash(const RunSummary& run) {
  results::Sha256 sum;
  for (const auto& [name, one] : run.cases) {
    sum.add(name);
    sum.add("\n");
  }
  return sum.digits();
}

Numbers counts_of(const text::Tally& tally) {
  Numbers counts;
  for (std::int64_t code = 0; const auto verdict = verdict_of(code); ++code)
    counts.push_back(static_cast<std::int64_t>(tally.of(*verdict)));
  return counts;
}

}  // namespace

Result<History> History::open(const std::string& path, Use use) {
  Result<std::unique_ptr<Database>> database = open_history(path, use);
  if (!database) return database.error();
  return History(path, std::move(*database));
}

std::string History::hash_of(const RunSummary& run, const CaseLists& lists) {
  results::Sha256 sum;
  for (const std::string& part : {head_of(run), names_hash(run), pack(lists.verdicts),
                                  pack(lists.revs), pack(lists.replies), pack(lists.times)}) {
    sum.add(std::to_string(part.size()));
    sum.add(" ");
    sum.add(part);
  }
  return sum.digits();
}

std::string History::protocols_of(const results::RunInfo& run) {
  const auto found = run.properties.find("protocol");
  return found == run.properties.end() ? "" : found->second;
}

Result<History::Added> History::add(const RunSummary& run) {
  const std::optional<std::int64_t> started = seconds_of(run.run.started);
  if (run.run.vectors_hash.empty() || !started)
    return fail(
        fmt::format("cannot add {}: it does not say {}; give results.ndjson or results.json",
                    run.path, started ? "which vectors it is of" : "when it was"));
  if (run.cases.empty())
    return fail(fmt::format("cannot add {}: there is no result in it", run.path));
  const CaseLists lists = lists_of(run);
  const std::string hash = hash_of(run, lists);
  Added added;
  added.device = device_of(run.run);
  return guarded(Use::write, path_, [&] {
    Transaction transaction(*database_);
    Statement known = database_->prepare("SELECT number FROM run WHERE hash = ?");
    added.is_new = !known.with(std::string_view(hash)).next();
    added.number =
        added.is_new ? insert(run, lists, added.device, hash, *started) : known.integer(0);
    transaction.commit();
    return added;
  });
}

std::int64_t History::insert(const RunSummary& run, const CaseLists& lists,
                             const std::string& device, const std::string& hash,
                             std::int64_t started) {
  Numbers messages, topic_names;
  std::unordered_map<std::string_view, std::int64_t> kept;
  for (const auto& [name, one] : run.cases) {
    const auto [at, is_new] = kept.try_emplace(one.message, 0);
    if (is_new) at->second = keep(one.message);
    messages.push_back(at->second);
  }
  const Topics topics = topics_of(run);
  for (const auto& [name, figures] : topics) topic_names.push_back(keep(name));
  const std::string head = head_of(run), ending = run.end ? json_of(*run.end) : "";
  const std::string counts = pack(counts_of(run.tally)), protocols = protocols_of(run.run);
  Statement statement = database_->prepare(
      "INSERT INTO run (hash, device, firmware, protocols, vectors, tool, started, started_s, "
      "complete, seconds, red, counts, cases, verdicts, repetitions, with_verdict, topics, revs, "
      "messages, floors, replies, times, info, exit_code, ending) "
      "VALUES (?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?,?)");
  const auto text = [](const std::string& one) { return std::string_view(one); };
  const auto bound = [&](const auto& exit_code, const auto& end) {
    statement
        .with(
            text(hash), keep_device(device), text(run.run.identity.firmware), text(protocols),
            text(run.run.vectors_hash), text(run.run.tool_version), text(run.run.started), started,
            std::int64_t{run.end && !run.end->interrupted}, run.end ? run.end->seconds : 0.0,
            static_cast<std::int64_t>(run.tally.gating(run.gate)), Blob{counts}, keep_cases(run),
            keep(lists.verdicts), keep(lists.repetitions), keep(lists.with_verdict),
            keep(to_numbers(topics, topic_names)), keep(lists.revs), keep(messages),
            keep(lists.floors), keep(lists.replies), keep(lists.times), text(head), exit_code, end)
        .run();
  };
  if (run.end)
    bound(std::int64_t{run.end->exit_code}, text(ending));
  else
    bound(nullptr, nullptr);
  return database_->last_id();
}

std::int64_t History::keep(const Numbers& numbers) {
  const std::string bytes = pack(numbers), hash = results::sha256_of(bytes);
  Statement known = database_->prepare("SELECT id FROM list WHERE hash = ?");
  if (known.with(std::string_view(hash)).next()) return known.integer(0);
  database_->prepare("INSERT INTO list (hash, bytes) VALUES (?, ?)")
      .with(std::string_view(hash), Blob{bytes})
      .run();
  return database_->last_id();
}

std::int64_t History::keep(const std::string& text) {
  Statement known = database_->prepare("SELECT id FROM text WHERE text = ?");
  if (known.with(std::string_view(text)).next()) return known.integer(0);
  database_->prepare("INSERT INTO text (text) VALUES (?)").with(std::string_view(text)).run();
  return database_->last_id();
}

std::int64_t History::keep_device(const std::string& device) {
  Statement known = database_->prepare("SELECT id FROM device WHERE name = ?");
  if (known.with(std::string_view(device)).next()) return known.integer(0);
  database_->prepare("INSERT INTO device (name) VALUES (?)").with(std::string_view(device)).run();
  return database_->last_id();
}

std::int64_t History::keep_cases(const RunSummary& run) {
  const std::string hash = names_hash(run);
  Statement known = database_->prepare("SELECT cases FROM selection WHERE hash = ?");
  if (known.with(std::string_view(hash)).next()) return known.integer(0);
  Statement find = database_->prepare("SELECT id FROM test_case WHERE name = ?");
  Statement insert = database_->prepare(
      "INSERT INTO test_case (name, title, manual, section) VALUES (?, ?, ?, ?)");
  Numbers ids;
  for (const auto& [name, one] : run.cases) {
    const bool is_known = find.with(std::string_view(name)).next();
    if (!is_known)
      insert
          .with(std::string_view(name), std::string_view(one.title), std::string_view(one.manual),
                std::string_view(one.section))
          .run();
    ids.push_back(is_known ? find.integer(0) : database_->last_id());
  }
  const std::int64_t cases = keep(to_steps(std::move(ids)));
  database_->prepare("INSERT INTO selection (hash, cases) VALUES (?, ?)")
      .with(std::string_view(hash), cases)
      .run();
  return cases;
}

}  // namespace fieldproof::history
