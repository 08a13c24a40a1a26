#include "harness/run/soak_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fieldproof::run {

namespace {

constexpr std::size_t most_stretches =
    160;  // between 80 and 160: a tenth is known to about one percent of the time
constexpr double most_samples = 500;

}  // namespace

void SoakLog::Stretch::add(const Stretch& other) {
  judged += other.judged;
  failed += other.failed;
  times.add(other.times);
}

bool SoakLog::take(const results::CaseResult& result, double now) {
  rounds_ = std::max(rounds_, result.repeat + 1);
  const bool judged =
                 results::is_judged(result.verdict) || result.verdict == results::Verdict::error,
             failed = judged && results::gates(result.verdict, gate_);
  note(result, now, judged, failed);
  OneCase& one = cases_[result.id];
  const bool first = one.counts.empty();
  ++one.counts[std::string(results::to_string(result.verdict))];
  for (const double ms : result.response_ms) one.times.add(ms);
  if (first) return true;
  if (!failed) return false;
  const bool room = one.written < failures_a_case && written_ < failures_in_all;
  if (room)
    ++one.written, ++written_;
  else
    ++unwritten_;
  return room;
}

void SoakLog::note(const results::CaseResult& result, double now, bool judged, bool failed) {
  judged_ += judged;
  failed_ += failed;
  for (Stretch* stretch : {&stretch_at(now), &since_sample_}) {
    stretch->judged += judged;
    stretch->failed += failed;
    for (const double ms : result.response_ms) stretch->times.add(ms);
  }
  for (const double ms : result.response_ms) times_.add(ms);
}

SoakLog::Stretch& SoakLog::stretch_at(double now) {
  while (now >= length_ * static_cast<double>(most_stretches)) {
    length_ *= 2;
    for (std::size_t i = 0; i < stretches_.size(); i += 2) {
      Stretch merged = std::move(stretches_[i]);
      if (i + 1 < stretches_.size()) merged.add(stretches_[i + 1]);
      stretches_[i / 2] = std::move(merged);
    }
    stretches_.resize((stretches_.size() + 1) / 2);
  }
  const auto index = static_cast<std::size_t>(now / length_);
  while (stretches_.size() <= index) stretches_.push_back({.from = 0});
  return stretches_[index];
}

std::optional<results::SoakSample> SoakLog::due_sample(double now) {
  if (now - since_sample_.from < std::max(1.0, planned_s_ / most_samples)) return std::nullopt;
  const Stretch done = std::exchange(since_sample_, {.from = now});
  return results::SoakSample{done.from, now, done.judged, done.failed,
                             results::figures_of(done.times)};
}

/// The stretches that begin in [from, to).
results::SoakSample SoakLog::tenth(double from, double to) const {
  Stretch sum;
  for (std::size_t i = 0; i < stretches_.size(); ++i) {
    const double begin = static_cast<double>(i) * length_;
    if (begin >= from && begin < to) sum.add(stretches_[i]);
  }
  return {from, to, sum.judged, sum.failed, results::figures_of(sum.times)};
}

results::SoakSummary SoakLog::summary(double now) const {
  results::SoakSummary summary;
  summary.seconds = now;
  summary.planned_s = planned_s_;
  summary.rounds = static_cast<std::uint64_t>(rounds_);
  summary.judged = judged_;
  summary.failed = failed_;
  summary.unwritten = unwritten_;
  summary.response = results::figures_of(times_);
  summary.first = tenth(0, now / 10);
  summary.last = tenth(now * 0.9, now);
  for (const auto& [id, one] : cases_)
    summary.cases[id] = {one.counts, results::figures_of(one.times)};
  return summary;
}

}  // namespace fieldproof::run
