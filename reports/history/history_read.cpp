#include <fmt/format.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "reports/history/device.hpp"
#include "reports/history/history.hpp"
#include "reports/results/result_json.hpp"
#include "reports/results/sha256.hpp"

namespace fieldproof::history {

using compare::RunSummary;

namespace {

constexpr const char* entry_columns =
    "run.number, device.name, firmware, protocols, vectors, tool, started, exit_code, complete, "
    "seconds, red, counts, cases, verdicts, repetitions, with_verdict, topics, started_s";

text::Tally tally_from(std::string_view bytes) {
  const std::optional<Numbers> counts = unpack(bytes);
  if (!counts) damaged("the counts of a run");
  text::Tally tally;
  for (std::size_t code = 0; code < counts->size(); ++code)
    if (const auto verdict = verdict_of(static_cast<std::int64_t>(code)))
      tally.add(*verdict, static_cast<std::size_t>((*counts)[code]));
  return tally;
}

RunEntry entry_of(const Statement& row) {
  RunEntry entry;
  entry.number = row.integer(0);
  entry.device = row.text(1);
  entry.firmware = row.text(2);
  entry.protocols = row.text(3);
  entry.vectors = row.text(4);
  entry.tool = row.text(5);
  entry.started = row.text(6);
  if (!row.is_null(7)) entry.exit_code = static_cast<int>(row.integer(7));
  entry.complete = row.integer(8) != 0;
  entry.seconds = row.real(9);
  entry.red = static_cast<std::size_t>(row.integer(10));
  entry.counts = tally_from(row.blob(11));
  entry.cases = row.integer(12);
  entry.verdicts = row.integer(13);
  entry.repetitions = row.integer(14);
  entry.with_verdict = row.integer(15);
  entry.topics = row.integer(16);
  entry.started_s = row.integer(17);
  return entry;
}

}  // namespace

Result<std::vector<RunEntry>> History::runs(const std::string& device) {
  return guarded(Use::read, path_, [&] {
    const std::string where = device.empty() ? "" : "WHERE device.name = ? ";
    Statement rows =
        database_->prepare(fmt::format("SELECT {} FROM run JOIN device ON device.id = run.device {}"
                                       "ORDER BY started_s, run.number",
                                       entry_columns, where));
    if (!device.empty()) rows.with(std::string_view(device));
    std::vector<RunEntry> entries;
    while (rows.next()) entries.push_back(entry_of(rows));
    return entries;
  });
}

Result<std::optional<RunSummary>> History::last_before(const RunSummary& run) {
  const std::string device = device_of(run.run), protocols = protocols_of(run.run);
  const std::string hash = hash_of(run, lists_of(run));
  constexpr std::int64_t any_time = std::numeric_limits<std::int64_t>::max();
  const Result<std::int64_t> number = guarded(Use::read, path_, [&] {
    Statement row = database_->prepare(
        "SELECT run.number FROM run JOIN device ON device.id = run.device "
        "WHERE device.name = ? AND protocols = ? AND started_s <= ? AND hash != ? AND complete "
        "ORDER BY started_s DESC, run.number DESC LIMIT 1");
    row.with(std::string_view(device), std::string_view(protocols),
             seconds_of(run.run.started).value_or(any_time), std::string_view(hash));
    return row.next() ? row.integer(0) : 0;
  });
  if (!number) return number.error();
  if (*number == 0) return std::optional<RunSummary>();
  Result<RunSummary> last = summary(*number);
  if (!last) return last.error();
  return std::optional(std::move(*last));
}

Result<RunSummary> History::summary(std::int64_t number) {
  return guarded(Use::read, path_, [&] {
    Statement row = database_->prepare(
        "SELECT info, ending, counts, cases, revs, verdicts, repetitions, with_verdict, floors, "
        "replies, times, messages FROM run WHERE number = ?");
    if (!row.with(number).next()) damaged(fmt::format("run {} is not there", number));
    RunSummary run;
    run.path = fmt::format("{}, run {}", path_, number);
    try {
      nlohmann::json::parse(row.text(0)).get_to(run.run);
      if (!row.is_null(1)) run.end = nlohmann::json::parse(row.text(1)).get<results::RunEnd>();
    } catch (const nlohmann::json::exception&) {
      damaged("the head of a run");
    }
    run.gate = text::gate_of(run.run);
    const CaseLists lists{read_list(row.integer(4)), read_list(row.integer(5)),
                          read_list(row.integer(6)), read_list(row.integer(7)),
                          read_list(row.integer(8)), read_list(row.integer(9)),
                          read_list(row.integer(10))};
    std::vector<std::string> names;
    const std::vector<CaseFacts> facts = read_cases(from_steps(read_list(row.integer(3))));
    for (const CaseFacts& one : facts) names.push_back(one.name);
    auto cases = cases_of(lists, names, texts(read_list(row.integer(11))));
    if (!cases) damaged("the lists of a run do not fit to each other");
    run.cases = std::move(*cases);
    for (const CaseFacts& one : facts) {
      compare::CaseSummary& summary = run.cases[one.name];
      summary.title = one.title;
      summary.manual = one.manual;
      summary.section = one.section;
    }
    run.tally = tally_from(row.blob(2));
    return run;
  });
}

std::string_view History::read_bytes(std::int64_t id) {
  if (!list_.with(id).next()) damaged("a list is missing");
  const std::string_view bytes = list_.blob(0);
  if (results::sha256_of(bytes) != list_.text(1)) damaged("a list is not what its hash says");
  return bytes;
}

Numbers History::read_list(std::int64_t id) {
  std::optional<Numbers> numbers = unpack(read_bytes(id));
  if (!numbers) damaged("a list");
  return std::move(*numbers);
}

Result<std::vector<Repeated>> History::repeated(std::int64_t id) {
  return guarded(Use::read, path_, [&] {
    std::optional<std::vector<Repeated>> parts = unpack_repeated(read_bytes(id));
    if (!parts) damaged("a list");
    return std::move(*parts);
  });
}

std::vector<std::string> History::texts(const Numbers& ids) {
  std::unordered_map<std::int64_t, std::string> known;
  Statement row = database_->prepare("SELECT text FROM text WHERE id = ?");
  std::vector<std::string> all;
  for (const std::int64_t id : ids) {
    const auto [at, is_new] = known.try_emplace(id);
    if (is_new) {
      if (!row.with(id).next()) damaged("a text is missing");
      at->second = row.text(0);
    }
    all.push_back(at->second);
  }
  return all;
}

std::vector<CaseFacts> History::read_cases(const Numbers& ids) {
  Statement row =
      database_->prepare("SELECT name, title, manual, section FROM test_case WHERE id = ?");
  std::vector<CaseFacts> all;
  for (const std::int64_t id : ids) {
    if (!row.with(id).next()) damaged("a case is missing");
    all.push_back({std::string(row.text(0)), std::string(row.text(1)), std::string(row.text(2)),
                   std::string(row.text(3))});
  }
  return all;
}

Result<Numbers> History::list(std::int64_t id) {
  return guarded(Use::read, path_, [&] { return read_list(id); });
}

Result<std::vector<CaseFacts>> History::cases(const Numbers& ids) {
  return guarded(Use::read, path_, [&] { return read_cases(ids); });
}

Result<std::string> History::text(std::int64_t id) {
  return guarded(Use::read, path_, [&] { return texts({id}).front(); });
}

}  // namespace fieldproof::history
