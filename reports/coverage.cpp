#include "reports/coverage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "reports/text/markdown_text.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::reports {

using results::Verdict;
using text::Tally;

namespace {

using nlohmann::ordered_json;

const char* word(Traced state) {
  switch (state) {
    case Traced::tested: return "tested";
    case Traced::failed: return "failed";
    case Traced::unjudged: return "not_judged";
    case Traced::measured: return "measured";
    case Traced::table: return "table";
    case Traced::reasoned: return "reason";
    case Traced::open: break;
  }
  return "open";
}

std::string plural(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

bool any_judged(const Tally& tally) {
  return std::ranges::any_of(Tally::verdicts, [&](Verdict verdict) {
    return results::is_judged(verdict) && tally.of(verdict) > 0;
  });
}

std::string verdicts_text(const CoverageStatement& statement) {
  const Tally verdicts = statement.verdicts();
  return verdicts.total() == 0 ? "not run" : text::to_string(verdicts);
}

std::string first_why_not(const CoverageStatement& statement) {
  for (const CoverageVector& vector : statement.vectors)
    if (!vector.why_not.empty()) return "; " + vector.why_not;
  return "";
}

ordered_json counts_json(const CoverageCounts& counts, bool with_results) {
  ordered_json object{{"statements", counts.total}, {"with_vector", counts.with_vector()}};
  for (const Traced state : {Traced::tested, Traced::failed, Traced::unjudged, Traced::measured,
                             Traced::table, Traced::reasoned, Traced::open})
    object[word(state)] = counts.count(state);
  object["percent"] = counts.percent(with_results);
  return object;
}

ordered_json vector_json(const CoverageVector& vector, bool with_results) {
  ordered_json object{{"id", vector.id},
                      {"title", vector.title},
                      {"kind", vector.table      ? "table"
                               : vector.measured ? "measured"
                                                 : "case"},
                      {"cases", vector.cases}};
  if (!with_results) return object;
  object["verdicts"] = ordered_json::object();
  for (const Verdict verdict : Tally::verdicts)
    if (vector.verdicts.of(verdict) > 0)
      object["verdicts"][std::string(results::to_string(verdict))] = vector.verdicts.of(verdict);
  if (!vector.why_not.empty()) object["not_judged"] = vector.why_not;
  return object;
}

}  // namespace

Tally CoverageStatement::verdicts() const {
  Tally sum;
  for (const CoverageVector& vector : vectors)
    for (const Verdict verdict : Tally::verdicts) sum.add(verdict, vector.verdicts.of(verdict));
  return sum;
}

Traced CoverageStatement::state(bool with_results) const {
  if (vectors.empty()) return reason.empty() ? Traced::open : Traced::reasoned;
  if (std::ranges::all_of(vectors, [](const CoverageVector& vector) { return vector.table; }))
    return Traced::table;
  const auto cannot_fail = [](const CoverageVector& one) { return one.table || one.measured; };
  if (std::ranges::all_of(vectors, cannot_fail)) return Traced::measured;
  const Tally sum = verdicts();
  if (sum.of(Verdict::fail) + sum.of(Verdict::xfail) > 0) return Traced::failed;
  return !with_results || any_judged(sum) ? Traced::tested : Traced::unjudged;
}

std::size_t CoverageCounts::count(Traced state) const {
  const auto found = of.find(state);
  return found == of.end() ? 0 : found->second;
}

double CoverageCounts::percent(bool with_results) const {
  const std::size_t tested = with_results ? judged() : with_vector();
  return total == 0 ? 100 : 100.0 * static_cast<double>(tested) / static_cast<double>(total);
}

CoverageCounts count_statements(const CoverageManual& manual, bool with_results) {
  CoverageCounts counts;
  for (const CoverageStatement& statement : manual.statements)
    counts.add(statement.state(with_results));
  return counts;
}

CoverageCounts count_statements(const Coverage& coverage) {
  CoverageCounts counts;
  for (const CoverageManual& manual : coverage.manuals)
    for (const CoverageStatement& statement : manual.statements)
      counts.add(statement.state(coverage.with_results()));
  return counts;
}

std::size_t count_proved(const Coverage& coverage) {
  std::size_t count = 0;
  for (const CoverageManual& manual : coverage.manuals)
    count += static_cast<std::size_t>(
        std::ranges::count_if(manual.statements, &CoverageStatement::proved));
  return count;
}

std::string coverage_summary(const Coverage& coverage) {
  const CoverageCounts counts = count_statements(coverage);
  std::string text = fmt::format("{}: {} with vectors, {} with a reason, {} open",
                                 plural(counts.total, "statement"), counts.with_vector(),
                                 counts.count(Traced::reasoned), counts.count(Traced::open));
  if (coverage.with_results())
    text += fmt::format(
        "; judged in {}: {}, of which {} failed; not judged there: {}, measured without a "
        "requirement: {}, facts without wire effect: {}",
        text::xml_line(coverage.results), counts.judged(), counts.count(Traced::failed),
        counts.count(Traced::unjudged), counts.count(Traced::measured),
        counts.count(Traced::table));
  if (coverage.with_faults)
    text += fmt::format(
        "; {} of those with vectors proved by a fault of a device that turns a case red which "
        "cites them",
        count_proved(coverage));
  return text + fmt::format("; coverage {:.1f} %", counts.percent(coverage.with_results()));
}

std::string trace_text(const CoverageStatement& statement, bool with_results) {
  const Traced state = statement.state(with_results);
  if (state == Traced::open) return "no vector and no reason";
  if (state == Traced::reasoned) return "no vector: " + statement.reason;
  std::size_t cases = 0;
  for (const CoverageVector& vector : statement.vectors) cases += vector.table ? 0 : vector.cases;
  std::string text = plural(statement.vectors.size(), "vector");
  if (state == Traced::table)
    return text + " of kind table, checked by `fieldproof lint`: no effect on the wire";
  text += ", " + plural(cases, "case");
  if (state == Traced::measured) text += ", measured: the manual sets no requirement";
  return with_results ? text + ": " + verdicts_text(statement) + first_why_not(statement) : text;
}

std::string coverage_text(const Coverage& coverage) {
  std::string text;
  for (const CoverageManual& manual : coverage.manuals) {
    text += fmt::format("{}{}  {}: {}\n", text.empty() ? "" : "\n", manual.id, manual.title,
                        manual.statements.empty() ? "no statements are listed yet"
                                                  : plural(manual.statements.size(), "statement"));
    const std::string* section = nullptr;
    for (const CoverageStatement& statement : manual.statements) {
      if (!section || *section != statement.section) text += "  " + statement.section + '\n';
      section = &statement.section;
      text += fmt::format("    {:<36}  {}\n", statement.id,
                          text::xml_line(trace_text(statement, coverage.with_results())));
    }
  }
  return text + '\n' + coverage_summary(coverage) + '\n';
}

std::string coverage_json(const Coverage& coverage) {
  const bool with_results = coverage.with_results();
  ordered_json all{{"schema", 1},
                   {"vectors_hash", coverage.vectors_hash},
                   {"results", with_results ? ordered_json(coverage.results) : ordered_json()},
                   {"counts", counts_json(count_statements(coverage), with_results)},
                   {"proved_by_fault",
                    coverage.with_faults ? ordered_json(count_proved(coverage)) : ordered_json()},
                   {"manuals", ordered_json::array()}};
  for (const CoverageManual& manual : coverage.manuals) {
    ordered_json statements = ordered_json::array();
    for (const CoverageStatement& statement : manual.statements) {
      ordered_json one{{"id", statement.id},
                       {"section", statement.section},
                       {"quote", statement.quote},
                       {"state", word(statement.state(with_results))}};
      if (coverage.with_faults) one["proved_by_fault"] = statement.proved;
      if (!statement.reason.empty()) one["reason"] = statement.reason;
      one["vectors"] = ordered_json::array();
      for (const CoverageVector& vector : statement.vectors)
        one["vectors"].push_back(vector_json(vector, with_results));
      statements.push_back(std::move(one));
    }
    all["manuals"].push_back(
        {{"id", manual.id},
         {"title", manual.title},
         {"counts", counts_json(count_statements(manual, with_results), with_results)},
         {"statements", std::move(statements)}});
  }
  return all.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
}

std::string coverage_markdown(const Coverage& coverage) {
  std::string text =
      fmt::format("# Traceability\n\n{}\n", text::markdown_cell(coverage_summary(coverage)));
  for (const CoverageManual& manual : coverage.manuals) {
    text += fmt::format("\n## {}: {}\n\n", text::markdown_cell(manual.id),
                        text::markdown_cell(manual.title));
    if (manual.statements.empty())
      text += "no statements are listed yet\n";
    else
      text += text::markdown_head({"section", "statement", "quote", "vectors", "result"});
    for (const CoverageStatement& statement : manual.statements) {
      std::string ids;
      for (const CoverageVector& vector : statement.vectors)
        ids += (ids.empty() ? "" : ", ") + vector.id;
      text += text::markdown_row({statement.section, statement.id, statement.quote, ids,
                                  trace_text(statement, coverage.with_results())});
    }
  }
  return text;
}

}  // namespace fieldproof::reports
