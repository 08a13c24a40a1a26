#include "harness/run/line_steps.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "harness/endpoints/kinds.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/line_matrix.hpp"
#include "harness/system/hook.hpp"

namespace fieldproof::run {

using line::LineSettings;
using results::Verdict;

namespace {

constexpr std::string_view filter_option = " --filter ";

/// The replay command of the run, for one step of its matrix.
std::string replay_of_step(std::string replay, const LineSettings& step) {
  return replay.insert(replay.size() - filter_option.size(),
                       " --matrix " + shell_word(matrix_text(step)));
}

}  // namespace

Status LineSteps::enter(std::size_t step,
                        const std::function<Result<std::string>(bench::Benches&)>& measure_floor) {
  current_ = step;
  const LineSettings& line = plan_.matrix[step];
  const Result<std::string> why = reconfigure(line, step + 1);
  if (!why) return why.error();
  blocked_ = *why;
  remark_ = fmt::format("line {}, step {} of {}", name(), step + 1, plan_.matrix.size());
  if (blocked_.empty()) {
    if (const Status opened = open(line); !opened) return opened;
    if (const Status started = benches_.start_those_that_answer(); !started) return started;
    if (benches_.stopped().empty()) {
      const Result<std::string> floor = measure_floor(benches_);
      if (!floor) return floor.error();
      if (!floor->empty()) remark_ += ": floor " + *floor;
    } else {
      blocked_ = benches_.stopped();
    }
  }
  if (!blocked_.empty()) remark_ += ": " + blocked_;
  return ok();
}

Result<std::string> LineSteps::reconfigure(const LineSettings& step, std::size_t number) {
  if (!quit_.empty()) return quit_;
  if (endpoints::kind_of(plan_.endpoint).emulated) return std::string();
  const std::string text = line::to_string(step);
  const std::string speed = text.substr(0, text.find('-')), frame = text.substr(text.find('-') + 1);
  if (!command_.empty()) {
    const Status done = os::run_hook(command_, {speed, frame},
                                     {{"FIELDPROOF_SPEED", speed}, {"FIELDPROOF_FRAME", frame}});
    if (!done && done.error().interrupted) return done.error();
    return done ? std::string() : "not reachable: " + done.error().message;
  }
  const Result<std::string> answer = os::ask(fmt::format(
      "\nstep {} of {}: set the device to {} bit/s, {}, and let it take the setting over.\n"
      "Enter = done, s = skip this step, q = quit the matrix: ",
      number, plan_.matrix.size(), speed, frame));
  if (!answer && answer.error().interrupted) return answer.error();
  if (!answer || answer->starts_with('q'))
    return quit_ = fmt::format("not run: the engineer ended the matrix before {}", text);
  return answer->starts_with('s') ? fmt::format("skipped by the engineer: {}", text)
                                  : std::string();
}

/// The port is closed before it is opened with other settings.
Status LineSteps::open(const LineSettings& step) {
  bench::BenchOptions options = plan_.bench;
  options.profile.config["line"] = line::to_string(step);
  options.replay = replay_of_step(options.replay, step);
  benches_.close();
  Result<bench::Benches> opened =
      bench::Benches::open(endpoints::with_line(plan_.endpoint, step), plan_.protocols, options);
  if (!opened) return opened.error();
  benches_ = std::move(*opened);
  return ok();
}

/// A case that names its own line is of one step alone, or of none.
std::string LineSteps::names_other_line(const vectors::Case& source) const {
  const auto line = source.config.find("line");
  if (line == source.config.end() || !line->is_string() || *line == name()) return {};
  const bool has_step = std::ranges::any_of(
      plan_.matrix, [&](const LineSettings& one) { return *line == line::to_string(one); });
  if (has_step || endpoints::kind_of(plan_.endpoint).emulated)
    return fmt::format("names its own line, {}; this step is {}", line->get<std::string>(), name());
  return {};
}

results::CaseResult LineSteps::run(const vectors::Case& source) {
  if (const std::string why = names_other_line(source); !why.empty())
    return decline(source, Verdict::skip, why);
  if (!blocked_.empty()) return decline(source, Verdict::blocked, blocked_);
  results::CaseResult result = benches_.run(source);
  result.line = name();
  const bool judged_well = result.verdict == Verdict::pass || result.verdict == Verdict::marginal ||
                           result.verdict == Verdict::non_strict;
  if (benches_.wire() || !judged_well) return result;
  result.notes.push_back(fmt::format("{} but for the line: {}", results::to_string(result.verdict),
                                     result.message.empty() ? "as written" : result.message));
  result.verdict = Verdict::inconclusive;
  result.message = fmt::format(
      "this link has no wire: it carries no speed and no character format, and proves nothing "
      "about {}",
      name());
  return result;
}

results::CaseResult LineSteps::decline(const vectors::Case& source, Verdict verdict,
                                       const std::string& why) const {
  results::CaseResult result = judging::result_of(source);
  result.line = name();
  result.verdict = verdict;
  result.message = why;
  result.replay = replay(source.id);
  return result;
}

std::string LineSteps::replay(const std::string& id) const {
  return replay_of_step(plan_.bench.replay, plan_.matrix[*current_]) + shell_word(id);
}

}  // namespace fieldproof::run
