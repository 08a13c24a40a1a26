#include "harness/judge/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <set>

namespace fieldproof::judging {

using exchange::PreparedFrame;
using exchange::PreparedStep;
using exchange::StepRecord;
using results::Difference;
using results::Verdict;
using vectors::Step;

namespace {

/// The beginning of what came, for a message of one line.
std::string shortened(ByteView bytes) {
  return notation::print_bytes(bytes.first(std::min<std::size_t>(bytes.size(), 64)));
}

class Judge {
 public:
  Judge(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
        const JudgeRules& rules, const harness::Protocol& protocol)
      : prepared_(prepared), transcript_(transcript), rules_(rules), protocol_(protocol) {}

  Judgement judge() {
    result_.verdict = Verdict::pass;
    if (transcript_.trouble) return error(transcript_.trouble->message);
    if (transcript_.flooded) miss("the device floods the line: it sends without end");
    for (const PreparedStep& step : prepared_.steps) {
      const StepRecord* previous = nullptr;
      periods_.clear();
      for (int i = 0; i < step.step->times && record_ < transcript_.steps.size(); ++i, ++record_) {
        judge_step(step, transcript_.steps[record_], previous);
        previous = &transcript_.steps[record_];
      }
      note_periods(step);
    }
    if (result_.verdict == Verdict::pass && record_ == 0) return error("no step was executed");
    if (!transcript_.surplus.bytes.empty()) judge_surplus();
    if (!transcript_.dead.empty()) miss("link dead after this frame: " + transcript_.dead);
    by_level();
    if (!unread_.empty())
      result_.notes.push_back(
          fmt::format("judged on the wire alone: {} cannot be read", fmt::join(unread_, ", ")));
    return std::move(result_);
  }

 private:
  Judgement error(std::string message) {
    result_.verdict = Verdict::error;
    result_.message = std::move(message);
    return std::move(result_);
  }

  /// The first miss names the case; its verdict is settled by level and basis at the end.
  void miss(std::string message) {
    if (missed_) return;
    missed_ = true;
    result_.verdict = Verdict::fail;
    result_.message = std::move(message);
  }

  /// A verdict short of a miss: the gravest one stays.
  void lower_to(Verdict verdict, std::string message) {
    if (missed_ || (result_.verdict != Verdict::pass && verdict == Verdict::marginal)) return;
    result_.verdict = verdict;
    result_.message = std::move(message);
  }

  void by_level() {
    const vectors::Case& source = *prepared_.source;
    if (result_.verdict == Verdict::blocked) return;
    if (missed_ && source.basis == "decision" && !rules_.binding_decisions) {
      result_.verdict = Verdict::non_strict;
      result_.notes.push_back("the manuals are silent here; this project decided: " + source.why);
    }
    if (missed_ && source.level == "should") result_.verdict = Verdict::non_strict;
    if (source.level == "info" && result_.verdict != Verdict::error) {
      result_.message = missed_ ? "measured, no requirement: " + result_.message
                                : "measured, no requirement: as written";
      result_.verdict = Verdict::info;
    }
  }

  void judge_step(const PreparedStep& step, const StepRecord& record, const StepRecord* previous) {
    if (!record.refused.empty()) return judge_refusal(record);
    switch (step.step->kind) {
      case Step::Kind::expect: return judge_reply(step, record, previous);
      case Step::Kind::silence:
      case Step::Kind::wait: return judge_silence(record);
      case Step::Kind::check: return judge_memory(*step.step, record);
      case Step::Kind::partner:
        if (step.step->every && previous) judge_period(*step.step->every, *previous, record);
        return;
      default: return;
    }
  }

  void judge_refusal(const StepRecord& record) {
    if (record.refused_by_device) return miss(record.refused);
    if (missed_) return;
    result_.verdict = Verdict::blocked;
    result_.message = record.refused;
    missed_ = true;
  }

  void judge_reply(const PreparedStep& step, const StepRecord& record, const StepRecord* previous) {
    const exchange::Received& received = record.received;
    if (received.bytes.empty()) {
      expected(step, received);
      return miss(fmt::format("no {} within {:.0f} ms",
                              prepared_.is_client() ? "request" : "answer",
                              to_ms(record.deadline - record.stimulus)));
    }
    result_.response_ms.push_back(to_ms(received.arrivals.front().start - record.stimulus));
    const PreparedFrame* match = matching(step, received.bytes);
    if (!match) return judge_mismatch(step, received);
    take_reading(step, *match);
    judge_timing(step, record);
    judge_gaps(step, received);
    if (step.step->every && previous) judge_period(*step.step->every, *previous, record);
  }

  const PreparedFrame* matching(const PreparedStep& step, ByteView bytes) {
    for (const PreparedFrame& one : step.frames) {
      notation::Captures captures = captures_;
      if (notation::first_mismatch(one.frame, bytes, captures)) continue;
      captures_ = std::move(captures);
      return &one;
    }
    return nullptr;
  }

  void judge_mismatch(const PreparedStep& step, const exchange::Received& received) {
    if (missed_) return;
    expected(step, received);
    const PreparedFrame& nearest = *result_.expected;
    if (received.bytes == last_sent())
      return miss(
          "our own request came back (echo) instead of a reply; check the wiring: RS-485 with two "
          "wires, or RS-422 set for RS-485");
    result_.differences =
        compare_frames(fill_holes(nearest.frame, received.bytes), received.bytes, protocol_);
    const std::string_view frame = prepared_.is_client() ? "request" : "reply";
    std::string what = fmt::format("the {} is not the one expected", frame);
    if (const std::size_t count = received.bytes.size(), size = nearest.frame.bytes.size();
        result_.differences.empty() && count != size)
      what = fmt::format("the {} has {} bytes instead of {}", frame, count, size);
    if (!result_.differences.empty()) {
      const Difference& first = result_.differences.front();
      what = fmt::format("{}: expected {}, got {}{}", first.field, first.expected, first.received,
                         first.hint.empty() ? "" : " (" + first.hint + ")");
    }
    miss(what);
  }

  Bytes last_sent() const {
    for (std::size_t i = record_; i-- > 0;)
      if (!transcript_.steps[i].sent_bytes.empty()) return transcript_.steps[i].sent_bytes;
    return {};
  }

  /// Notes which alternative comes nearest, and what came.
  void expected(const PreparedStep& step, const exchange::Received& received) {
    if (missed_) return;
    result_.received = received;
    std::size_t best = 0;
    for (const PreparedFrame& one : step.frames) {
      notation::Captures captures = captures_;
      const std::size_t agreeing = notation::first_mismatch(one.frame, received.bytes, captures)
                                       .value_or(received.bytes.size()) +
                                   1;
      if (agreeing <= best) continue;
      best = agreeing;
      result_.expected = &one;
    }
  }

  /// The template with the received bytes in its open places, so that only real differences show.
  static Bytes fill_holes(const notation::FrameTemplate& frame, ByteView received) {
    Bytes bytes = frame.bytes;
    for (std::size_t i = 0; i < bytes.size() && i < received.size(); ++i)
      if (frame.cells[i].kind != notation::FrameTemplate::Cell::Kind::literal)
        bytes[i] = received[i];
    for (const notation::FrameTemplate::Check& check : frame.checks) {
      const Bytes right = notation::check_bytes(check, bytes);
      const std::size_t size = bytes.size() - std::min(bytes.size(), check.at);
      std::copy_n(right.begin(), std::min(right.size(), size),
                  bytes.begin() + static_cast<std::ptrdiff_t>(bytes.size() - size));
    }
    return bytes;
  }

  void take_reading(const PreparedStep& step, const PreparedFrame& match) {
    if (!step.step->reading.empty()) {
      result_.readings[step.step->reading] = match.reading;
      if (match.reading != step.frames.front().reading)
        lower_to(Verdict::non_strict,
                 fmt::format("allowed alternative: {} = {}", step.step->reading, match.reading));
    }
    for (const auto& [field, reading] : match.frame.readings) {
      result_.readings[field] = reading;
      if (reading != field)
        lower_to(Verdict::non_strict, fmt::format("allowed alternative: {} = {}", field, reading));
    }
  }

  void judge_timing(const PreparedStep& step, const StepRecord& record) {
    const Duration limit = record.deadline - record.stimulus;
    const Duration took = record.received.arrivals.front().start - record.stimulus;
    if (limit < rules_.timing_floor)
      return lower_to(
          Verdict::inconclusive,
          fmt::format("the limit of {:.1f} ms is below the floor of this link, {:.1f} ms",
                      to_ms(limit), to_ms(rules_.timing_floor)));
    if (took > limit) {
      const std::string message =
          fmt::format("late {}: {:.1f} ms after {}, the limit is {:.0f} ms",
                      prepared_.is_client() ? "request" : "answer", to_ms(took),
                      prepared_.is_client() ? "what it follows" : "the request", to_ms(limit));
      return rules_.binding_timing || step.step->within ? miss(message)
                                                        : lower_to(Verdict::non_strict, message);
    }
    if (static_cast<double>(took.count()) >
        static_cast<double>(limit.count()) * (1 - rules_.guard_band))
      lower_to(
          Verdict::marginal,
          fmt::format("answered after {:.1f} ms: inside the guard band of the limit, {:.0f} ms",
                      to_ms(took), to_ms(limit)));
    if (rules_.turnaround_min > 0ns) judge_turnaround(took);
  }

  void judge_turnaround(Duration took) {
    const Duration least = rules_.turnaround_min;
    if (least < rules_.timing_floor)
      return lower_to(
          Verdict::inconclusive,
          fmt::format("the turnaround of {:.1f} ms is below the floor of this link, {:.1f} ms",
                      to_ms(least), to_ms(rules_.timing_floor)));
    if (took < least) {
      const std::string message = fmt::format(
          "early answer: {:.3f} ms after the request, the turnaround is {:.3f} ms at least",
          to_ms(took), to_ms(least));
      return rules_.binding_timing ? miss(message) : lower_to(Verdict::non_strict, message);
    }
    if (static_cast<double>(took.count()) <
        static_cast<double>(least.count()) * (1 + rules_.guard_band))
      lower_to(Verdict::marginal,
               fmt::format(
                   "answered after {:.3f} ms: inside the guard band of the turnaround, {:.3f} ms",
                   to_ms(took), to_ms(least)));
  }

  void judge_gaps(const PreparedStep& step, const exchange::Received& received) {
    const Duration limit = step.step->max_gap.value_or(rules_.max_gap);
    for (std::size_t i = 1; i < received.arrivals.size(); ++i) {
      const Duration gap = received.arrivals[i].start - received.arrivals[i - 1].end;
      if (gap > limit)
        return miss(
            fmt::format("split answer: {:.1f} ms of silence before byte {} of the reply, the limit "
                        "is {:.1f} ms",
                        to_ms(gap), received.arrivals[i].offset, to_ms(limit)));
    }
  }

  void judge_period(Duration every, const StepRecord& previous, const StepRecord& record) {
    if (previous.received.arrivals.empty() || record.received.arrivals.empty()) return;
    const Duration period =
        record.received.arrivals.front().start - previous.received.arrivals.front().start;
    const Duration tolerance = rules_.period_tolerance > 0ns
                                   ? rules_.period_tolerance
                                   : std::max<Duration>(every / 20, rules_.timing_floor);
    const Duration off = period > every ? period - every : every - period;
    periods_.push_back(period);
    if (off > tolerance)
      return miss(fmt::format("came after {:.1f} ms instead of every {:.1f} ms", to_ms(period),
                              to_ms(every)));
    if (static_cast<double>(off.count()) >
        static_cast<double>(tolerance.count()) * (1 - rules_.guard_band))
      lower_to(Verdict::marginal, fmt::format("came after {:.1f} ms instead of every {:.1f} ms: "
                                              "inside the guard band of the tolerance, {:.1f} ms",
                                              to_ms(period), to_ms(every), to_ms(tolerance)));
  }

  void note_periods(const PreparedStep& step) {
    if (periods_.empty()) return;
    std::ranges::sort(periods_);
    result_.notes.push_back(fmt::format(
        "every {:g} ms: measured min {:.3f}, median {:.3f}, max {:.3f} ms of {} periods",
        to_ms(*step.step->every), to_ms(periods_.front()), to_ms(periods_[periods_.size() / 2]),
        to_ms(periods_.back()), periods_.size()));
  }

  void judge_silence(const StepRecord& record) {
    if (record.received.bytes.empty() || missed_) return;
    result_.received = record.received;
    miss(fmt::format("{} bytes came where silence is due: {}", record.received.bytes.size(),
                     shortened(record.received.bytes)));
  }

  void judge_memory(const Step& step, const StepRecord& record) {
    for (const auto& [address, due] : step.memory) {
      const auto held =
          std::ranges::find(record.memory, address, &std::pair<std::string, std::string>::first);
      if (held == record.memory.end()) {
        unread_.insert(address);
        continue;
      }
      const std::string& value = held->second;
      if (std::ranges::equal(value, due,
                             [](char a, char b) { return hex_digit(a) == hex_digit(b); }))
        continue;
      if (!missed_) result_.differences.push_back({address, due, value, ""});
      miss(fmt::format("{} holds {}, {} is due", address, value, due));
    }
  }

  void judge_surplus() {
    if (missed_) return;
    result_.received = transcript_.surplus;
    const Bytes& bytes = transcript_.surplus.bytes;
    const char* hint = protocol_.frame_length(bytes) == bytes.size()
                           ? " (a whole frame: do two devices have this station number?)"
                           : "";
    miss(fmt::format("{} bytes after the complete exchange{}: {}", bytes.size(), hint,
                     shortened(bytes)));
  }

  const exchange::PreparedCase& prepared_;
  const exchange::Transcript& transcript_;
  const JudgeRules& rules_;
  const harness::Protocol& protocol_;
  Judgement result_;
  notation::Captures captures_;
  std::set<std::string> unread_;   // memory that was to be checked
  std::vector<Duration> periods_;  // of the present step
  std::size_t record_ = 0;
  bool missed_ = false;
};

}  // namespace

Judgement judge(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
                const JudgeRules& rules, const harness::Protocol& protocol) {
  return Judge(prepared, transcript, rules, protocol).judge();
}

results::CaseResult result_of(const vectors::Case& source) {
  results::CaseResult result;
  result.id = source.id;
  result.rev = source.rev;
  result.protocol = source.protocol;
  result.title = source.title;
  result.level = source.level;
  result.basis = source.basis;
  result.manual = source.source.manual;
  result.section = source.source.section;
  result.quote = source.source.quote;
  return result;
}

void note_transposition(const exchange::PreparedCase& prepared, results::CaseResult& result) {
  if (prepared.is_client()) return;  // a client's own station is nowhere on the line
  const int named =
      vectors::config_station(prepared.source->config, prepared.station).value_or(prepared.station);
  if (named != prepared.station)
    result.notes.push_back(fmt::format("transposed: station {} to {}", named, prepared.station));
}

void take_judgement(Judgement judgement, results::CaseResult& result) {
  result.verdict = judgement.verdict;
  result.message = std::move(judgement.message);
  std::ranges::move(judgement.notes, std::back_inserter(result.notes));
  result.differences = std::move(judgement.differences);
  result.readings = std::move(judgement.readings);
  result.response_ms = std::move(judgement.response_ms);
  if (judgement.expected) {
    result.expected = judgement.expected->source->text;
    result.expected_bytes = judgement.expected->frame.bytes;
    result.expected_hex = notation::to_hex_with_holes(judgement.expected->frame);
  }
  result.received = notation::print_bytes(judgement.received.bytes);
  result.received_bytes = std::move(judgement.received.bytes);
}

std::vector<Difference> compare_frames(ByteView expected, ByteView received,
                                       const harness::Protocol& protocol) {
  std::vector<harness::Field> due = protocol.explain(expected);
  std::vector<std::pair<std::size_t, Difference>>
      found;  // with the place in the frame: what comes first, a check follows from
  for (const harness::Field& field : protocol.explain(received)) {
    const auto same = std::ranges::find(due, field.name, &harness::Field::name);
    if (same == due.end()) {
      found.push_back({field.offset, {field.name, "nothing", field.text, field.problem}});
      continue;
    }
    if (same->text != field.text)
      found.push_back({std::max(same->offset, field.offset),
                       {field.name, same->text, field.text, field.problem}});
    due.erase(same);
  }
  for (const harness::Field& field : due)
    found.push_back({field.offset, {field.name, field.text, "nothing", ""}});
  std::ranges::stable_sort(found, {}, &std::pair<std::size_t, Difference>::first);
  std::vector<Difference> differences;
  for (auto& [place, difference] : found) differences.push_back(std::move(difference));
  return differences;
}

}  // namespace fieldproof::judging
