#include "reports/console.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "reports/text/case_text.hpp"
#include "reports/text/fold.hpp"
#include "reports/text/run_text.hpp"
#include "reports/text/xml_text.hpp"

namespace fieldproof::reports {

using results::CaseResult;
using results::Delivery;
using results::RunInfo;
using results::RunLog;
using results::Verdict;

namespace {

constexpr std::size_t verdict_width = 14;   // INCONCLUSIVE and two spaces
constexpr std::size_t console_limit = 256;  // bytes of a frame; the reports have them all
constexpr std::size_t red_limit = 20;       // red cases in full, by a line, and in the summary
constexpr int widest_head = 100;
constexpr Duration shortest_display = 20ms;
const std::string erase_line = "\r\x1b[K";

const char* colour_code(Verdict verdict, const results::Gate& gate) {
  if (results::gates(verdict, gate)) return "1;31";  // bold red
  switch (verdict) {
    case Verdict::pass:
    case Verdict::info: return "32";  // green
    case Verdict::skip: return "2";   // faint
    default: return "33";             // yellow: not as it should be, though the gate lets it pass
  }
}

std::string coloured(const std::string& text, const char* code, const ConsoleOptions& options) {
  return options.terminal && options.colour ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
}

/// The word of a verdict in its colour, then blanks up to `width`.
std::string verdict_word(Verdict verdict, std::size_t width, const ConsoleOptions& options) {
  const std::string word(results::to_string(verdict));
  return coloured(word, colour_code(verdict, options.gate), options) +
         std::string(width - word.size(), ' ');
}

std::string counts(const text::Tally& tally, const ConsoleOptions& options) {
  const std::size_t digits = std::to_string(tally.total()).size();
  std::string text;
  for (Verdict verdict : text::Tally::verdicts) {
    if (tally.of(verdict) == 0) continue;
    const std::string word = verdict_word(verdict, verdict_width, options);
    text += fmt::format("  {:>{}}  {}{}{}\n", tally.of(verdict), digits, word,
                        text::verdict_meaning(verdict), text::gate_hint(verdict, options.gate));
  }
  if (const std::string models = text::on_model_text(tally); !models.empty())
    text += fmt::format("  of them {}\n", models);
  return text;
}

std::string red_cases(const text::Failures& failures, const std::string& rest) {
  std::string text;
  const std::vector<const text::Finding*> repeated = failures.repeated();
  for (std::size_t i = 0; i < std::min(repeated.size(), red_limit); ++i)
    text += fmt::format("  {}\n", text::xml_line(text::to_string(*repeated[i])));
  if (repeated.size() > red_limit)
    text += fmt::format("  ... and {} more findings{}\n", repeated.size() - red_limit, rest);
  const std::vector<std::string> red = failures.single();
  for (std::size_t i = 0; i < std::min(red.size(), red_limit); ++i)
    text += fmt::format("  {}\n", red[i]);
  if (red.size() > red_limit)
    text += fmt::format("  ... and {} more{}\n", red.size() - red_limit, rest);
  return text.empty() ? "" : "\nred:\n" + text;
}

/// Where each case is told in full.
std::string place_of_all(const Summary& summary) {
  for (const auto& [kind, path] : summary.reports)
    if (kind == "html") return ", each in full in " + path;
  return "";
}

/// Why some were not judged, a line a reason.
std::string why_not_judged(const Summary& summary, const ConsoleOptions& options) {
  constexpr std::size_t most = 5;
  const std::vector<text::UnjudgedReason> reasons = summary.not_judged.reasons();
  if (reasons.empty()) return "";
  const std::size_t digits = std::to_string(summary.tally.total()).size();
  const bool nothing = summary.tally.judged() + summary.tally.of(Verdict::error) == 0;
  std::string text = nothing ? "\nnothing was judged" : "\nnot judged, and why";
  text += summary.tally.of(Verdict::blocked) > 0 ? ", or what it takes:\n" : ":\n";
  for (std::size_t i = 0; i < std::min(reasons.size(), most); ++i)
    text += fmt::format("  {:>{}}  {}{}\n", reasons[i].cases, digits,
                        verdict_word(reasons[i].verdict, verdict_width, options),
                        text::xml_line(reasons[i].text));
  if (reasons.size() > most)
    text += fmt::format("  ... and {} more reason{}{}\n", reasons.size() - most,
                        reasons.size() - most == 1 ? "" : "s", place_of_all(summary));
  return text;
}

/// "45 s", "3 min", "2 h".
std::string rough_time(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  return seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60)
                        : fmt::format("{:.0f} h", seconds / 3600);
}

std::string outcome(const Summary& summary, const ConsoleOptions& options) {
  const int code = summary.end.exit_code;
  const char* const colour = code != 0                                ? "1;31"
                             : text::is_less_than_half(summary.tally) ? "33"
                                                                      : "32";
  return fmt::format("exit {}: {}\n", code,
                     coloured(text::headline(summary.end, summary.tally), colour, options));
}

/// Items side by side, in lines of a width: an item goes on in the next line only where it fits in
/// none. All lines but the first are indented.
class Lines {
 public:
  explicit Lines(std::size_t width) : width_(width) {}

  void add(std::string_view item) {
    if (!line_.empty() && line_.size() + 2 + item.size() > width_) end();
    line_ += line_.empty() ? indentation() : "  ";
    for (std::size_t room; item.size() > (room = width_ - std::min(line_.size(), width_));) {
      const std::size_t blank = item.rfind(' ', room);
      if (blank == std::string_view::npos || blank == 0) break;  // one word
      line_ += item.substr(0, blank);
      item.remove_prefix(blank + 1);
      end();
      line_ = "    ";
    }
    line_ += item;
  }
  void end() {
    if (!line_.empty()) text_ += line_ + '\n';
    line_.clear();
  }
  std::string take() { return end(), std::move(text_); }

 private:
  std::string indentation() const { return text_.empty() ? "" : "  "; }

  std::size_t width_;
  std::string text_, line_;
};

}  // namespace

std::string run_head(const RunInfo& run, const ConsoleOptions& options) {
  std::vector<std::string> items{"fieldproof " + run.tool_version, run.endpoint};
  if (!run.profile.empty()) items.push_back("profile " + run.profile);
  for (const auto& [name, value] : run.properties) items.push_back(name + '=' + value);
  const int width = options.width > 0 ? std::min(options.width, widest_head) : widest_head;
  Lines lines(static_cast<std::size_t>(width));
  for (const std::string& item : items) lines.add(text::xml_line(item));
  for (const results::DutInfo& dut : run.duts) {
    lines.end();
    lines.add(text::xml_line(dut.identity.name + ": " + text::device_text(dut)));
  }
  return lines.take();
}

std::string case_report(const results::CaseResult& result, const ConsoleOptions& options,
                        const text::Finding* again, bool in_full) {
  const bool red = results::gates(result.verdict, options.gate);
  if (!red && !options.verbose) return "";
  std::string text =
      verdict_word(result.verdict, verdict_width, options) + text::case_label(result);
  if (!result.message.empty()) text += "  " + text::xml_line(result.message);
  const bool told = again && again->is_again() && !options.verbose;
  const std::string clause = result.section.empty() ? "" : result.section + ", ";
  text += told ? fmt::format("  ({}as {})\n", clause, again->first.front()) : "\n";
  if (!in_full) return text;
  // A case that never started has nothing but its message.
  const bool executed = red || !result.exchange.empty();
  const auto room = static_cast<std::size_t>(std::max(options.width - 2, 0));
  if (executed && !told)
    text += text::indent(
                text::case_block(
                    result, {.limit = console_limit, .exchange = options.verbose, .width = room}),
                2) +
            '\n';
  return text;
}

std::string Progress::line(const text::Tally& tally, std::size_t total, const std::string& next_id,
                           Duration elapsed) {
  const std::size_t done = tally.total();
  const std::size_t left = total - std::min(done, total);
  const std::string of = std::to_string(total);
  std::string text = fmt::format("[{:>{}}/{}] ", done, of.size(), of);
  if (const std::size_t red = tally.gating(options_.gate); red > 0)
    text += fmt::format("{} red, ", red);
  text += fmt::format("{} to go", left);
  if (done > 0 && elapsed >= 1s)
    text += ", ~" + rough_time(std::chrono::duration<double>(elapsed).count() /
                               static_cast<double>(done) * static_cast<double>(left));
  return line(text + "  " + text::xml_line(next_id), elapsed);
}

std::string Progress::line(std::string text, Duration elapsed) {
  if (!options_.terminal || (shown_ && elapsed - drawn_ < shortest_display)) return "";
  // A line that wraps cannot be erased.
  const auto room = static_cast<std::size_t>(std::max(options_.width - 1, 0));
  if (text.size() > room) text.resize(room);
  shown_ = true;
  drawn_ = elapsed;
  return erase_line + text;
}

std::string Progress::erase() { return std::exchange(shown_, false) ? erase_line : ""; }

std::string run_summary(const Summary& summary, const ConsoleOptions& options) {
  const std::size_t total = summary.tally.total();
  std::string text =
      fmt::format("\n{} case{} in {:.1f} s\n", total, total == 1 ? "" : "s", summary.end.seconds);
  text += counts(summary.tally, options);
  if (const std::string timing = text::timing_text(summary.timing); !timing.empty())
    text += '\n' + timing;
  if (summary.soak) text += '\n' + results::soak_text(*summary.soak);
  text += red_cases(summary.red, place_of_all(summary)) + why_not_judged(summary, options);
  std::size_t width = 0;
  for (const auto& [kind, path] : summary.reports) width = std::max(width, kind.size());
  if (!summary.reports.empty()) text += '\n';
  for (const auto& [kind, path] : summary.reports)
    text += fmt::format("{:<{}}  {}\n", kind, width, path);
  return text + '\n' + outcome(summary, options);
}

std::string ConsoleReport::folded(const std::string& text) const {
  return text::fold(text, static_cast<std::size_t>(options_.width));
}

Status ConsoleReport::begin(const RunInfo& run) {
  return print_(folded(run_head(run, options_))), ok();
}

const text::Finding* ConsoleReport::count(const CaseResult& result) {
  summary_.tally.add(result);
  timing_.add(result);
  if (!results::is_judged(result.verdict) && result.verdict != Verdict::error)
    summary_.not_judged.add(result);
  return gates(result.verdict, options_.gate) ? &summary_.red.add(result) : nullptr;
}

std::string ConsoleReport::red_case(const CaseResult& result, const text::Finding& finding) {
  const bool in_full = !finding.is_again() && in_full_ < red_limit;
  if (!in_full && in_lines_ > red_limit) return "";
  ++(in_full ? in_full_ : in_lines_);
  return in_lines_ > red_limit && !in_full
             ? "further failures are counted; the reports have each in full\n"
             : case_report(result, options_, &finding, in_full);
}

Status ConsoleReport::add(const Delivery& one) {
  const text::Finding* finding = count(*one);
  const std::string text = finding && !options_.verbose ? red_case(*one, *finding)
                                                        : case_report(*one, options_, finding);
  if (!text.empty()) print_(progress_.erase() + folded(text));
  return ok();
}

Status ConsoleReport::end(const RunLog& log) {
  if (log.end) summary_.end = *log.end;
  summary_.timing = timing_.rows();
  summary_.soak = log.soak;
  print_(folded(run_summary(summary_, options_)));
  return ok();
}

}  // namespace fieldproof::reports
