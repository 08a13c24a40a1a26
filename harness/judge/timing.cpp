#include "harness/judge/timing.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::judging {

using results::Verdict;

namespace {

/// What a client's scan and reaction shift its clocks by: no manual prints it, p2p/clocks has so
/// much.
constexpr Duration scan_and_reaction = 2500us;

double scaled(Duration duration, double factor) {
  return static_cast<double>(duration.count()) * factor;
}

}  // namespace

bool judge_limit(const Limit& one, const JudgeRules& rules, Findings& findings) {
  if (one.limit < rules.timing_floor) {
    findings.lower_to(
        Verdict::inconclusive,
        fmt::format("the limit of {:.1f} ms is below the floor of this link, {:.1f} ms",
                    to_ms(one.limit), to_ms(rules.timing_floor)));
    return false;
  }
  if (one.took > one.limit && one.took <= one.limit + rules.timing_floor) {
    findings.lower_to(
        Verdict::inconclusive,
        fmt::format("{} {:.1f} ms after {}, the limit is {:.0f} ms: the floor of this link, {:.1f} "
                    "ms, is more than the difference",
                    one.what, to_ms(one.took), one.after, to_ms(one.limit),
                    to_ms(rules.timing_floor)));
    return false;
  }
  if (one.took > one.limit) {
    findings.miss_or_lower(rules.timing_binds() || one.stated,
                           fmt::format("late {}: {:.1f} ms after {}, the limit is {:.0f} ms",
                                       one.what, to_ms(one.took), one.after, to_ms(one.limit)));
    return false;
  }
  if (scaled(one.took, 1) > scaled(one.limit, 1 - rules.guard_band))
    findings.lower_to(
        Verdict::marginal,
        fmt::format("answered after {:.1f} ms: inside the guard band of the limit, {:.0f} ms",
                    to_ms(one.took), to_ms(one.limit)));
  return true;
}

void judge_turnaround(Duration took, const JudgeRules& rules, Findings& findings) {
  const Duration least = rules.turnaround_min;
  if (least == 0ns) return;
  if (least < rules.timing_floor)
    return findings.lower_to(
        Verdict::inconclusive,
        fmt::format("the turnaround of {:.1f} ms is below the floor of this link, {:.1f} ms",
                    to_ms(least), to_ms(rules.timing_floor)));
  if (took < least)
    return findings.miss_or_lower(
        rules.timing_binds(),
        fmt::format(
            "early answer: {:.3f} ms after the request, the turnaround is {:.3f} ms at least",
            to_ms(took), to_ms(least)));
  if (scaled(took, 1) < scaled(least, 1 + rules.guard_band))
    findings.lower_to(
        Verdict::marginal,
        fmt::format("answered after {:.3f} ms: inside the guard band of the turnaround, {:.3f} ms",
                    to_ms(took), to_ms(least)));
}

void judge_gaps(const exchange::Received& received, const GapLimit& gap, Findings& findings) {
  if (gap.of_case && gap.limit < gap.floor)
    findings.lower_to(Verdict::inconclusive,
                      fmt::format("the limit of {:.1f} ms for silence inside a frame is below what "
                                  "this link can show, {:.1f} ms",
                                  to_ms(gap.limit), to_ms(gap.floor)));
  Duration longest{};
  std::size_t before = 0;
  for (std::size_t i = 1; i < received.arrivals.size(); ++i) {
    const Duration silence = received.arrivals[i].start - received.arrivals[i - 1].end;
    if (silence > longest) longest = silence, before = received.arrivals[i].offset;
  }
  if (longest <= gap.limit) return;
  const std::string came = fmt::format(
      "split answer: {:.1f} ms of silence before byte {} of the reply, the limit is "
      "{:.1f} ms",
      to_ms(longest), before, to_ms(gap.limit));
  if (longest > gap.limit + gap.floor) return findings.miss(came);
  findings.lower_to(Verdict::inconclusive,
                    fmt::format("{}: this link may make {:.1f} ms itself", came, to_ms(gap.floor)));
}

void Periods::add(Duration every, const exchange::Received& previous,
                  const exchange::Received& received, const JudgeRules& rules, Findings& findings) {
  if (previous.arrivals.empty() || received.arrivals.empty()) return;
  const Duration period = received.arrivals.front().start - previous.arrivals.front().start;
  const Duration tolerance =
      rules.period_tolerance > 0ns
          ? rules.period_tolerance
          : std::max({Duration(every / 20), scan_and_reaction, rules.timing_floor});
  const Duration off = period > every ? period - every : every - period;
  measured_.push_back(period);
  const std::string came =
      fmt::format("came after {:.1f} ms instead of every {:.1f} ms", to_ms(period), to_ms(every));
  if (off > tolerance) return findings.miss(came);
  if (scaled(off, 1) > scaled(tolerance, 1 - rules.guard_band))
    findings.lower_to(Verdict::marginal,
                      fmt::format("{}: inside the guard band of the tolerance, {:.1f} ms", came,
                                  to_ms(tolerance)));
}

void Periods::note(Duration every, Findings& findings) {
  if (measured_.empty()) return;
  std::ranges::sort(measured_);
  findings.result.notes.push_back(
      fmt::format("every {:g} ms: measured min {:.3f}, median {:.3f}, max {:.3f} ms of {} periods",
                  to_ms(every), to_ms(measured_.front()), to_ms(measured_[measured_.size() / 2]),
                  to_ms(measured_.back()), measured_.size()));
  measured_.clear();
}

}  // namespace fieldproof::judging
