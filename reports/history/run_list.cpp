#include "reports/history/run_list.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reports/compare/compare_text.hpp"
#include "reports/history/counts_json.hpp"
#include "reports/history/table.hpp"
#include "reports/results/result_json.hpp"
#include "reports/text/timing_table.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::history {

using nlohmann::ordered_json;
using results::Verdict;

namespace {

constexpr std::size_t shown_cases = 50;

std::string end_of(const RunEntry& run) {
  if (!run.exit_code) return "killed";
  return run.complete ? fmt::format("exit {}", *run.exit_code) : "interrupted";
}

bool is_remarkable(Verdict verdict) {
  return verdict != Verdict::pass && verdict != Verdict::info && verdict != Verdict::skip;
}

ordered_json json_of_part(const auto& part) {
  std::string text;
  results::append_json(text, part);
  return ordered_json::parse(text);
}

}  // namespace

std::string list_text(const std::vector<RunEntry>& runs, std::size_t last) {
  Table table{{"run", "started", "device", "firmware", "vectors", "judged", "red", "end"}, {}};
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    table.rows.push_back({std::to_string(run->number), run->started, run->device, run->firmware,
                          run->vectors, std::to_string(run->counts.judged()),
                          std::to_string(run->red), end_of(*run)});
  const std::string text = table_text("runs", table, last, " before these; --last 0 shows all");
  return text.empty() ? text : text.substr(1);
}

std::string list_json(const std::vector<RunEntry>& runs) {
  ordered_json list = ordered_json::array();
  for (const RunEntry& run : runs)
    list.push_back({{"run", run.number},
                    {"started", run.started},
                    {"device", run.device},
                    {"firmware", run.firmware},
                    {"protocols", run.protocols},
                    {"vectors", run.vectors},
                    {"tool", run.tool},
                    {"counts", counts_json(run.counts)},
                    {"red", run.red},
                    {"exit_code", run.exit_code ? ordered_json(*run.exit_code) : ordered_json()},
                    {"complete", run.complete},
                    {"seconds", run.seconds}});
  return list.dump(1) + '\n';
}

std::string show_text(const RunEntry& entry, const compare::RunSummary& run) {
  Table table{{"verdict", "case", "what was said"}, {}};
  for (const auto& [name, one] : run.cases)
    if (is_remarkable(one.verdict) || one.with_verdict < one.repetitions)
      table.rows.push_back({compare::verdict_text(&one), name, one.message});
  const Topics topics = topics_of(run);
  text::TimingTable::Rows rows(topics.begin(), topics.end());
  for (auto& [name, figures] : rows)
    if (name.empty()) name = "all";
  const std::string times = text::timing_text(rows);
  return fmt::format("run {}: {}\n{}\n{}, {} results: {}\n", entry.number, entry.device,
                     compare::run_facts(run), end_of(entry), run.tally.total(),
                     text::to_string(run.tally)) +
         table_text("cases that did not plainly hold", table, shown_cases,
                    "; --json has all of them") +
         (times.empty() ? "" : "\n" + times);
}

std::string show_json(const RunEntry& entry, const compare::RunSummary& run) {
  ordered_json cases = ordered_json::array();
  for (const auto& [name, one] : run.cases)
    cases.push_back({{"id", name},
                     {"verdict", results::to_string(one.verdict)},
                     {"message", one.message},
                     {"title", one.title},
                     {"rev", one.rev},
                     {"repetitions", one.repetitions},
                     {"with_verdict", one.with_verdict},
                     {"response_ms", one.response_ms}});
  return ordered_json{{"run", entry.number},
                      {"device", entry.device},
                      {"info", json_of_part(run.run)},
                      {"end", run.end ? json_of_part(*run.end) : ordered_json()},
                      {"counts", counts_json(run.tally)},
                      {"cases", std::move(cases)}}
             .dump(1) +
         '\n';
}

}  // namespace fieldproof::history
