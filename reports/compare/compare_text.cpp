#include "reports/compare/compare_text.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reports/text/fold.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::compare {
namespace {

std::string runs_table(const ComparisonSet& set) {
  std::string text;
  for (std::size_t i = 0; i < set.runs.size(); ++i) {
    const RunSummary& run = set.runs[i];
    text += fmt::format(
        "{}  {}\n   {}\n   {} results: {}{}\n", ComparisonSet::letter(i), text::xml_line(run.path),
        run_facts(run), run.tally.total(), text::to_string(run.tally),
        run.end && !run.end->interrupted ? ""
                                         : "; the file does not say that the run came to its end");
  }
  return text;
}

/// Lines below a heading, as many as there is room for.
template <typename Line>
std::string list(const std::string& heading, std::size_t count, const CompareTextOptions& options,
                 const Line& line) {
  if (count == 0) return "";
  std::string text = fmt::format("\n{} ({})\n", heading, count);
  const std::size_t shown = options.limit == 0 ? count : std::min(count, options.limit);
  for (std::size_t i = 0; i < shown; ++i) text += line(i);
  if (shown < count)
    text += fmt::format("  ... and {} more; --html FILE shows all\n", count - shown);
  return text;
}

std::string change_line(const CaseChange& change) {
  const std::string id = text::xml_line(change.id);
  if (!change.before) return fmt::format("  {}  {}\n", id, verdict_text(change.after));
  if (!change.after) return fmt::format("  {}  was {}\n", id, verdict_text(change.before));
  std::string text =
      fmt::format("  {}  {} -> {}", id, verdict_text(change.before), verdict_text(change.after));
  if (change.change == Change::revised)
    text += fmt::format("  rev {} -> {}", change.before->rev, change.after->rev);
  text += '\n';
  if (change.change == Change::newly_passing || change.change == Change::revised) return text;
  if (change.change == Change::other_reason)
    text += fmt::format("      was: {}\n      now: {}\n", text::xml_line(change.before->message),
                        text::xml_line(change.after->message));
  else if (!change.after->message.empty())
    text += fmt::format("      {}\n", text::xml_line(change.after->message));
  return text;
}

std::string changes_text(const Comparison& comparison, const CompareTextOptions& options) {
  std::string text;
  auto first = comparison.changes.begin();
  for (Change change : all_changes) {
    const std::size_t count = comparison.count(change);
    text += list(to_string(change) + ": " + meaning(change), count, options,
                 [&](std::size_t i) { return change_line(first[static_cast<std::ptrdiff_t>(i)]); });
    first += static_cast<std::ptrdiff_t>(count);
  }
  return text;
}

std::string times_text(const Comparison& comparison, const CompareTextOptions& options) {
  const TimingTest& timing = comparison.timing;
  if (timing.tested + timing.too_few == 0) return "";
  std::string text =
      list("reply times shifted", comparison.shifts.size(), options, [&](std::size_t i) {
        const TimeShift& shift = comparison.shifts[i];
        return fmt::format("  {}  {}\n      {}\n", shift.shift_ms > 0 ? "slower" : "faster",
                           text::xml_line(shift.id), shift_text(shift));
      });
  if (text.empty())
    text = timing.tested > 0 ? "\nreply times: no shift that is more than chance\n"
                             : "\nreply times: not tested\n";
  return text + text::paragraph(describe(timing), 110);
}

std::string matrix_text(const ComparisonSet& set, const CompareTextOptions& options) {
  const auto count = static_cast<std::size_t>(std::ranges::count_if(set.rows, &MatrixRow::differs));
  const std::size_t shown = options.limit == 0 ? count : std::min(count, options.limit);
  std::vector<std::size_t> widths(set.runs.size(), 1);
  std::size_t id_width = 4;
  for (std::size_t r = 0; r < shown; ++r) {
    id_width = std::max(id_width, text::xml_line(set.rows[r].id).size());
    for (std::size_t i = 0; i < widths.size(); ++i)
      widths[i] = std::max(widths[i], verdict_text(set.rows[r].cells[i]).size());
  }
  const auto row = [&](const std::string& name, const auto& cell) {
    std::string line = fmt::format("  {:<{}}", name, id_width);
    for (std::size_t i = 0; i < widths.size(); ++i)
      line += fmt::format("  {:<{}}", cell(i), widths[i]);
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
  };
  const std::string text = list("cases that differ", count, options, [&](std::size_t r) {
    return row(text::xml_line(set.rows[r].id),
               [&](std::size_t i) { return verdict_text(set.rows[r].cells[i]); });
  });
  const std::size_t heading = text.find('\n', 1) + 1;
  return text.empty()
             ? text
             : text.substr(0, heading) + row("case", ComparisonSet::letter) + text.substr(heading);
}

}  // namespace

std::string run_facts(const RunSummary& run) {
  std::string text;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty())
      text += fmt::format("{}{}{}", text.empty() ? "" : ", ", name, text::xml_line(value));
  };
  const results::Identity& device = run.run.identity;
  add("", run.run.started);
  add("", run.run.endpoint);
  add("profile ", run.run.profile);
  add("", device.maker.empty() ? device.model : device.maker + " " + device.model);
  add("serial number ", device.serial);
  add("firmware ", device.firmware);
  add("vectors ", run.run.vectors_hash);
  add("gate ", text::to_string(run.gate));
  return text;
}

std::string verdict_text(const CaseSummary* summary) {
  if (!summary) return "-";
  std::string text(results::to_string(summary->verdict));
  if (summary->with_verdict < summary->repetitions)
    text += fmt::format(" in {} of {}", summary->with_verdict, summary->repetitions);
  return text;
}

std::string shift_text(const TimeShift& shift) {
  const double share = shift.before_ms > 0 ? 100 * shift.shift_ms / shift.before_ms : 0;
  return fmt::format(
      "{:.3f} to {:.3f} ms ({:+.3f} ms{}), p {:.2g}, corrected {:.2g}, {} and {} replies",
      shift.before_ms, shift.after_ms, shift.shift_ms,
      shift.before_ms > 0 ? fmt::format(", {:+.0f} %", share) : "", shift.p, shift.corrected_p,
      shift.replies_before, shift.replies_after);
}

std::string compare_text(const ComparisonSet& set, const CompareTextOptions& options) {
  std::string text = runs_table(set);
  for (std::size_t i = 0; i < set.comparisons.size(); ++i) {
    const Comparison& one = set.comparisons[i];
    if (set.comparisons.size() > 1)
      text += fmt::format("\n==== {} against {}\n", ComparisonSet::letter(i + 1),
                          ComparisonSet::letter(0));
    text += changes_text(one, options) + times_text(one, options);
    text += fmt::format("\n{} to {}: {}; {} of {} cases unchanged\n", ComparisonSet::letter(0),
                        ComparisonSet::letter(i + 1), outcome(one), one.unchanged,
                        one.unchanged + one.changes.size());
  }
  if (set.runs.size() > 2) text += matrix_text(set, options);
  return text;
}

}  // namespace fieldproof::compare
