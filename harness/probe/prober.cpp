#include "harness/probe/prober.hpp"

#include <algorithm>
#include <type_traits>

namespace fieldproof::probe {

namespace {

/// More than any reply and a second one; a line that goes on talks without end.
constexpr std::size_t flood = 2048;

/// For the last question of a search that may take only so long, and its confirmation.
constexpr Duration last_answers = 900ms;

bool is_sure(Symptom symptom) {
  return symptom == Symptom::reply || symptom == Symptom::second_reply;
}

template <typename T>
bool contains(const std::vector<T>& all, const std::type_identity_t<T>& one) {
  return std::ranges::find(all, one) != all.end();
}

}  // namespace

std::vector<Trial> suggestions(const Observation& observation) {
  const Trial& trial = observation.trial;
  const Diagnosis& diagnosis = observation.diagnosis;
  if (!trial.protocol) return {};
  if (diagnosis.right_format) return {{*diagnosis.right_format, trial.protocol, trial.station}};
  if (diagnosis.station >= 0)
    return {{trial.line, diagnosis.protocol, diagnosis.station},
            {trial.line, diagnosis.protocol, trial.station}};
  return {};
}

Result<Search> Prober::run(std::vector<Trial> rest, bool all) {
  if (rest.empty()) return search_;
  for (const Trial& one : rest)
    if (!known_line(one.line)) lines_.push_back(one.line);
  rest.insert(rest.begin(), Trial{rest.front().line});
  total_ = rest.size();
  while (!rest.empty() && !out_of_time()) {
    const Trial trial = rest.front();
    rest.erase(rest.begin());
    const Result<bool> sure = try_next(trial, rest);
    if (!sure && sure.error().interrupted) {
      search_.interrupted = true;
      break;
    }
    if (!sure) return sure.error();
    if (*sure && !all) break;
  }
  if (search_.trials == 0 && !first_refusal_.empty()) return fail(first_refusal_);
  return std::move(search_);
}

bool Prober::known_line(const line::LineSettings& line) const { return contains(lines_, line); }

/// True when the search has its answer.
Result<bool> Prober::try_next(const Trial& trial, std::vector<Trial>& rest) {
  const Result<bool> open = settle(trial.line);
  if (!open) return open.error();
  if (!*open) return false;
  Result<Observation> seen = observe(trial);
  if (!seen) return seen.error();
  seen->late = contains(done_, {trial.line, seen->diagnosis.protocol, seen->diagnosis.station}) &&
               !is_sure(seen->diagnosis.symptom);
  const bool again = contains(done_, trial);
  done_.push_back(trial);
  if (trial.protocol && !again) search_.asked.push_back(trial);
  keep(*seen);
  const Symptom symptom = seen->diagnosis.symptom;
  if (!trial.protocol) {
    // Someone talks: at which settings can it be read?
    std::vector<Trial> others;
    if (symptom != Symptom::silence && symptom != Symptom::foreign_frame)
      for (const line::LineSettings& line : lines_) others.push_back({line});
    insert_next(rest, others);
    return symptom == Symptom::foreign_frame;
  }
  if (is_sure(symptom)) return confirm(trial);
  if (seen->heard.silent() && !again && may_be_starting()) {
    rest.push_back(trial);
    ++total_;
  }
  if (symptom == Symptom::damaged && again) return confirm(trial);
  if (symptom == Symptom::damaged) {
    // Perhaps the refusal of a device that speaks another protocol: those first, then this question
    // again.
    const auto others = std::ranges::stable_partition(rest, [&](const Trial& one) {
      return one.line == trial.line && one.station == trial.station;
    });
    rest.insert(others.begin(), trial);
  }
  insert_next(rest, suggestions(*seen));
  return false;
}

/// Puts them in front, once. What has been asked before and shows itself now was late: it is asked
/// again with patience.
void Prober::insert_next(std::vector<Trial>& rest, const std::vector<Trial>& trials) {
  std::size_t at = 0;
  for (const Trial& one : trials) {
    if (!known_line(one.line)) continue;
    if (contains(done_, one)) {
      if (late_ || !one.protocol || one == done_.back()) continue;
      late_ = true;
    }
    std::erase(rest, one);
    rest.insert(rest.begin() + static_cast<std::ptrdiff_t>(at++), one);
  }
}

bool Prober::out_of_time(Duration grace) {
  if (timing_.budget == 0ns || !endpoint_) return false;
  if (!begun_) begun_ = endpoint_->now();
  return endpoint_->now() > *begun_ + timing_.budget + grace;
}

bool Prober::may_be_starting() const {
  return endpoint_->starts() > 0 && endpoint_->now() < opened_ + timing_.starting;
}

/// Opens the line with other settings; false when the port does not offer them.
Result<bool> Prober::settle(const line::LineSettings& line) {
  if (contains(refused_, line)) return false;
  if (endpoint_ && line == line_) return true;
  endpoint_.reset();
  Result<std::unique_ptr<endpoints::Endpoint>> opened = open_(line);
  if (!opened) {
    if (opened.error().interrupted || opened.error().absent) return opened.error();
    if (first_refusal_.empty()) first_refusal_ = opened.error().message;
    refused_.push_back(line);
    search_.not_offered.push_back(opened.error().message);
    return false;
  }
  endpoint_ = std::move(*opened);
  opened_ = endpoint_->now();
  line_ = line;
  if (!contains(search_.lines, line)) search_.lines.push_back(line);
  return true;
}

Result<Observation> Prober::observe(const Trial& trial) {
  Observation seen{.trial = trial, .heard = {}, .diagnosis = {}};
  Heard& heard = seen.heard;
  const Duration gap =
      trial.protocol ? trial.protocol->frame_gap(endpoint_->character_time()) : timing_.listen;
  if (const Status done =
          listen(endpoint_->now() + std::max(gap, listening_time(trial.line)), heard.before);
      !done)
    return done.error();
  if (trial.protocol) {
    const Result<Sent> sent = endpoint_->send(trial.protocol->probe(trial.station, {}));
    if (!sent) return sent.error();
    heard.asked_until = sent->end;
    const Time until =
        sent->end + (late_ ? timing_.late : timing_.wait) + endpoint_->character_time();
    if (const Status done = listen(until, heard.after); !done) return done.error();
  }
  heard.errors = endpoint_->line_errors();
  seen.diagnosis = diagnose(trial, heard, known_);
  ++search_.trials;
  return seen;
}

/// Collects what comes until `until`, and behind the last byte a silence: a second device may be
/// slower than the first.
Status Prober::listen(Time until, std::vector<Burst>& heard) {
  std::size_t size = 0;
  while (size < flood && !out_of_time(last_answers)) {
    Result<Burst> burst = endpoint_->receive(until);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) return ok();
    until = std::max(until, burst->end() + timing_.quiet);
    size += burst->bytes.size();
    heard.push_back(std::move(*burst));
  }
  return ok();
}

/// Twice more: is it always the same, and how long does it take? False when the line fell silent.
Result<bool> Prober::confirm(const Trial& trial) {
  bool heard = true;
  for (int again = 0; again < 2; ++again) {
    const Result<Observation> seen = observe(trial);
    if (!seen) return seen.error();
    keep(*seen);
    heard = heard && seen->diagnosis.symptom != Symptom::silence;
  }
  return heard;
}

void Prober::keep(const Observation& observation) {
  if (!observation.heard.silent()) search_.observations.push_back(observation);
  progress_(search_.trials, std::max(total_, search_.trials), observation);
}

}  // namespace fieldproof::probe
