#include "harness/judge/judge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <set>

#include "harness/exchange/memory_runs.hpp"
#include "harness/exchange/timing.hpp"
#include "harness/judge/endings.hpp"
#include "harness/judge/findings.hpp"
#include "harness/judge/timing.hpp"
#include "harness/judge/token_rules.hpp"
#include "harness/notation/beginning.hpp"
#include "harness/notation/notation.hpp"

namespace fieldproof::judging {

using exchange::PreparedFrame;
using exchange::PreparedStep;
using exchange::Received;
using exchange::Share;
using exchange::StepRecord;
using results::Verdict;
using vectors::Step;

namespace {

std::string on_link(const std::string& name) { return name.empty() ? "" : " on " + name; }

class Judge {
 public:
  Judge(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
        const JudgeRules& rules, const harness::Protocol& protocol)
      : prepared_(prepared),
        transcript_(transcript),
        rules_(rules),
        protocol_(protocol),
        client_(prepared.is_client()),
        shares_(exchange::shares_of(transcript)) {}

  Judgement judge() {
    if (transcript_.trouble) return error(transcript_.trouble->message);
    if (transcript_.flooded) findings_.miss(without_end());
    for (const PreparedStep& step : prepared_.steps) {
      judge_repeated(step);
      if (!too_close_.empty()) break;
    }
    if (findings_.result.verdict == Verdict::pass && record_ == 0)
      return error("no step was executed");
    if (too_close_.empty())
      judge_surplus();
    else
      findings_.lower_to(Verdict::inconclusive, too_close_);
    for (const NetTrace& net : transcript_.trace.nets)
      if (const std::string rule = broken_token_rule(net); !rule.empty())
        findings_.miss(fmt::format("token bus of net {}: {}", net.net, rule));
    if (!transcript_.dead.empty())
      findings_.miss_in_any_case("link dead after this frame: " + transcript_.dead);
    findings_.settle(*prepared_.source, rules_.decisions);
    if (!unread_.empty()) judge_unread();
    if (passed_over_ > 0) judge_passed_over();
    return std::move(findings_.result);
  }

 private:
  Judgement error(std::string message) {
    findings_.result.verdict = Verdict::error;
    findings_.result.message = std::move(message);
    return std::move(findings_.result);
  }

  /// A step as often as it was executed.
  void judge_repeated(const PreparedStep& step) {
    Periods periods;
    for (int i = 0; i < step.step->times && record_ < transcript_.steps.size(); ++i, ++record_) {
      const bool came = judge_step(step, transcript_.steps[record_], shares_.steps[record_]);
      if (step.step->kind == Step::Kind::act) paced_.clear();  // no period goes on over it
      if (step.step->every) judge_pace(step, came, periods);
    }
    if (step.step->every) periods.note(*step.step->every, findings_);
    if (findings_.missed() && !findings_.result.failed) findings_.result.failed = step.step;
  }

  /// The period from the last time that a step with `every` took the same frame.
  void judge_pace(const PreparedStep& step, bool came, Periods& periods) {
    const Received*& last = paced_[step.frames.front().frame.bytes];
    const Received* const now = came ? &shares_.steps[record_].received : nullptr;
    if (last && now) periods.add(*step.step->every, *last, *now, rules_, findings_);
    last = now;
  }

  /// True: a frame came that the step is about.
  bool judge_step(const PreparedStep& step, const StepRecord& record, const Share& share) {
    if (!record.refused.empty()) {
      record.refused_by_device ? findings_.miss(record.refused) : findings_.block(record.refused);
      return false;
    }
    switch (step.step->kind) {
      case Step::Kind::expect: return judge_reply(step, record, share);
      case Step::Kind::partner: return true;
      case Step::Kind::wait:
        waited_until_ = record.cause;
        if (ends_too_close(record, share.received)) return false;
        [[fallthrough]];
      case Step::Kind::silence: judge_silence(share.received); return false;
      case Step::Kind::check:
        ++looks_;
        if (record.passed_over)
          ++passed_over_;
        else
          judge_memory(*step.step, record);
        return false;
      case Step::Kind::expect_close: judge_ending(step, record, share.ending); return false;
      case Step::Kind::expect_open: judge_opening(step, record, share.opened); return false;
      default: return false;
    }
  }

  /// What nobody has looked at is not judged; what the line has shown against the device stands,
  /// and so does a case that is about the line.
  void judge_unread() {
    const bool counters_alone =
        std::ranges::all_of(unread_, [](const std::string& one) { return one.starts_with('@'); });
    const std::string not_read = fmt::format(
        "{} could not be read{}", fmt::join(unread_, ", "),
        counters_alone ? ": no request asks for counters" : "; give --aux, a second port of it");
    if (stands_without_it() || prepared_.source->line_alone)
      return findings_.result.notes.push_back("judged on the wire alone: " + not_read);
    leave_open(
        "the line shows nothing wrong, but what the case looks at in the device is not judged: " +
        not_read);
  }

  void judge_passed_over() {
    const std::string not_judged = fmt::format(
        "not judged: {} of {} looks, at what is so for milliseconds, which no request that is sent "
        "here hits",
        passed_over_, looks_);
    if (stands_without_it()) return findings_.result.notes.push_back(not_judged);
    leave_open("what is seen at rest is right; " + not_judged);
  }

  /// What was seen against the device needs no more; for it, all would have to be right.
  bool stands_without_it() const {
    return findings_.missed() || findings_.result.verdict == Verdict::error;
  }

  void leave_open(std::string why) {
    if (!findings_.result.message.empty())
      findings_.result.notes.push_back(findings_.result.message);
    findings_.lower_to(Verdict::inconclusive, std::move(why));
  }

  std::string without_end() const {
    std::size_t count = 0;
    Time first{}, last{};
    for (const results::Event& event : transcript_.events) {
      if (event.kind != results::Event::Kind::received) continue;
      if (count == 0) first = event.start;
      count += event.bytes.size();
      last = event.end;
    }
    if (count > exchange::flood_limit) return "the device floods the line: it sends without end";
    return fmt::format("the {} does not end: {} bytes came in {:.0f} ms",
                       client_ ? "request" : "reply", count, to_ms(last - first));
  }

  std::string frame() const { return client_ ? "request" : "answer"; }
  std::string before() const { return client_ ? "what it follows" : "the request"; }

  bool judge_reply(const PreparedStep& step, const StepRecord& record, const Share& share) {
    if (!findings_.missed()) findings_.result.due = {record.cause, record.deadline};
    const Received& received = share.received;
    if (received.arrivals.empty()) {
      expected(step, received);
      if (client_ && came_too_early(step)) {
        findings_.miss(pipelining + std::string(", while the one before it was unanswered"));
        return false;
      }
      const std::string why =
          share.ending ? ": " + in_words(share.ending, record.cause, before())
                       : fmt::format(" within {:.0f} ms{}", to_ms(record.deadline - record.cause),
                                     on_link(step.link) + came_elsewhere(step));
      findings_.miss("no " + frame() + why);
      return false;
    }
    const Duration took = received.arrivals.front().start - record.cause;
    if (client_ && took < -rules_.timing_floor && is_end_of_answer(record.cause)) {
      findings_.miss(
          fmt::format("{}: {:.1f} ms before the answer to the one before it was complete",
                      pipelining, -to_ms(took)));
      return false;
    }
    if (!client_ && rules_.earliest < 0ns && took < rules_.earliest)
      findings_.lower_to(
          Verdict::inconclusive,
          fmt::format("the reply began {:.1f} ms before the request was over: it is that to an "
                      "earlier request, or this port has no wire behind it",
                      -to_ms(took)));
    findings_.result.response_ms.push_back(to_ms(took));
    const PreparedFrame* match = matching(step, received.bytes);
    if (!match && client_) match = in_other_letters(step, received.bytes);
    if (!match) {
      judge_mismatch(step, record, share);
      return false;
    }
    take_reading(step, *match);
    const Limit limit{frame(), before(), step.step->within.has_value(),
                      record.deadline - record.cause, took};
    // Nobody shares a connection with the bench, and its bytes may come in any pieces.
    if (judge_limit(limit, rules_, findings_) && !step.network)
      judge_turnaround(took, rules_, findings_);
    if (!step.network || step.step->max_gap) judge_gaps(received, gap_limit(step), findings_);
    return true;
  }

  GapLimit gap_limit(const PreparedStep& step) const {
    if (step.step->max_gap) return {*step.step->max_gap, rules_.gap_floor, true};
    return {rules_.max_gap, rules_.gap_stated ? rules_.gap_floor : Duration{}};
  }

  static constexpr const char* pipelining = "pipelining: the request came too early";

  bool is_end_of_answer(Time moment) const {
    return std::ranges::any_of(transcript_.events, [&](const results::Event& event) {
      return event.kind == results::Event::Kind::sent && event.end == moment;
    });
  }

  /// Was the request among what no step was waiting for?
  bool came_too_early(const PreparedStep& step) const {
    const ByteView surplus = shares_.surplus.received.bytes;
    return std::ranges::any_of(step.frames, [&](const PreparedFrame& one) {
      const std::size_t size = one.frame.bytes.size();
      for (std::size_t at = 0; at + size <= surplus.size(); ++at) {
        notation::Captures captures = captures_;
        if (!notation::first_mismatch(one.frame, surplus.subspan(at, size), captures)) return true;
      }
      return false;
    });
  }

  /// Bytes that came on another link while this one was silent.
  std::string came_elsewhere(const PreparedStep& step) const {
    const Received& surplus = shares_.surplus.received;
    if (surplus.arrivals.empty() || surplus.link == step.link) return {};
    return fmt::format("; {} bytes came{}", surplus.bytes.size(), on_link(surplus.link));
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

  const PreparedFrame* in_other_letters(const PreparedStep& step, ByteView bytes) {
    const PreparedFrame* match = matching(step, spoken(step).in_plain_letters(bytes));
    if (match)
      findings_.lower_to(Verdict::non_strict,
                         "allowed alternative: letters in the other case, where the manual leaves "
                         "them to the client");
    return match;
  }

  const harness::Protocol& spoken(const PreparedStep& step) const {
    return step.protocol ? *step.protocol : protocol_;
  }

  void judge_mismatch(const PreparedStep& step, const StepRecord& record, const Share& share) {
    if (findings_.missed()) return;
    const Received& received = share.received;
    expected(step, received);
    const bool repeated = !client_ && received.bytes == last_sent();
    if (repeated && spoken(step).reply_repeats(received.bytes))
      return findings_.miss(difference(step, received) +
                            " (the request came back, which is its normal reply)");
    if (repeated)
      return findings_.miss(
          "our own request came back (echo) instead of a reply" +
          std::string(step.network ? ""
                                   : "; check the wiring: RS-485 with two wires, or RS-422 set for "
                                     "RS-485"));
    std::string what = difference(step, received);
    if (share.ending) what += "; " + in_words(share.ending, record.cause, before());
    findings_.miss(what + of_an_earlier_request(step, received.bytes));
  }

  /// The requests that may have set what the case begins with.
  std::vector<Bytes> set_ups(const harness::Protocol& protocol) const {
    std::vector<Bytes> all;
    using harness::Protocol;
    const auto add = [&](const Protocol::Setting& value) {
      if (const auto requests =
              protocol.write_requests(prepared_.station, value.first, value.second))
        all.insert(all.end(), requests->begin(), requests->end());
    };
    for (const exchange::MemoryRun run : exchange::runs_of(prepared_.source->memory, protocol)) {
      if (run.size() > 1) add(exchange::as_one(run));
      for (const Protocol::Setting& value : run) add(value);
    }
    return all;
  }

  /// What has the form of an answer to something else that was asked in this case, and not to this.
  std::string of_an_earlier_request(const PreparedStep& step, ByteView reply) const {
    const harness::MemoryRequests* const memory = spoken(step).memory();
    if (client_ || !memory || memory->answers(last_sent(), reply)) return {};
    const auto told = [&](ByteView request) {
      return memory->answers(request, reply)
                 ? fmt::format(" (an answer to what was asked before, {}: it came twice, or late)",
                               notation::print_bytes(request))
                 : "";
    };
    for (std::size_t i = 0; i < record_; ++i)
      if (const Bytes& sent = shares_.steps[i].sent; !sent.empty())
        if (std::string found = told(sent); !found.empty()) return found;
    for (const Bytes& request : set_ups(spoken(step)))
      if (std::string found = told(request); !found.empty()) return found;
    return {};
  }

  std::string difference(const PreparedStep& step, const Received& received) {
    const PreparedFrame& nearest = *findings_.result.expected;
    auto& differences = findings_.result.differences;
    const Bytes came = client_ ? spoken(step).in_plain_letters(received.bytes) : received.bytes;
    differences = compare_frames(fill_holes(nearest.frame, came), came, spoken(step), client_);
    const std::string_view name = client_ ? "request" : "reply";
    if (!differences.empty()) {
      const results::Difference& first = differences.front();
      return fmt::format("{}: expected {}, got {}{}", first.field, first.expected, first.received,
                         first.hint.empty() ? "" : " (" + first.hint + ")");
    }
    if (const std::size_t count = received.bytes.size(), size = nearest.frame.bytes.size();
        count != size)
      return fmt::format("the {} has {} bytes instead of {}", name, count, size);
    return fmt::format("the {} is not the one expected", name);
  }

  const Bytes& last_sent() const {
    static const Bytes nothing;
    for (std::size_t i = record_; i-- > 0;)
      if (!shares_.steps[i].sent.empty()) return shares_.steps[i].sent;
    return nothing;
  }

  /// Notes which alternative comes nearest, and what came.
  void expected(const PreparedStep& step, const Received& received) {
    if (findings_.missed()) return;
    findings_.result.received = received;
    std::size_t best = 0;
    for (const PreparedFrame& one : step.frames) {
      notation::Captures captures = captures_;
      const std::size_t agreeing = notation::first_mismatch(one.frame, received.bytes, captures)
                                       .value_or(received.bytes.size()) +
                                   1;
      if (agreeing <= best) continue;
      best = agreeing;
      findings_.result.expected = &one;
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

  void take(const std::string& name, const std::string& choice, bool preferred) {
    const auto [taken, is_new] = findings_.result.readings.try_emplace(name, choice);
    if (!is_new && taken->second != choice)
      findings_.lower_to(Verdict::non_strict, fmt::format("mixes readings: {} = {}, and {} before",
                                                          name, choice, taken->second));
    else if (!preferred)
      findings_.lower_to(Verdict::non_strict,
                         fmt::format("allowed alternative: {} = {}", name, choice));
  }

  void take_reading(const PreparedStep& step, const PreparedFrame& match) {
    if (!step.step->reading.empty())
      take(step.step->reading, match.alternative,
           match.alternative == step.frames.front().alternative);
    for (const auto& [field, choice] : match.frame.readings) take(field, choice, choice == field);
  }

  void judge_ending(const PreparedStep& step, const StepRecord& record,
                    const exchange::Ending& ending) {
    if (!ending && step.step->may_stay) return;
    if (!ending)
      return findings_.miss(
          fmt::format("the device did not close the connection{} within {:.0f} ms",
                      on_link(step.link), to_ms(record.deadline - record.cause)));
    const LinkEvent event =
        ending.event->kind == results::Event::Kind::reset ? LinkEvent::reset : LinkEvent::closed;
    const std::string how = in_words(ending, record.cause, "what it follows");
    if (step.step->ending && *step.step->ending != event)
      return findings_.miss(how + (event == LinkEvent::reset ? "; FIN is due" : "; RST is due"));
    // A limit that ended within the wait asks whether it has ended by now.
    if (!step.step->may_stay && record.deadline > waited_until_ &&
        is_early(ending.event->start, record))
      return findings_.miss(how + "; it had no reason to before the end of the wait");
    findings_.result.notes.push_back(how);
    judge_limit({"end of the connection", "what it follows", step.step->within.has_value(),
                 record.deadline - record.cause, ending.event->start - record.cause},
                rules_, findings_);
  }

  /// What it follows, or the end of the wait before: until then nothing was due.
  Time reason_for(const StepRecord& record) const { return std::max(record.cause, waited_until_); }

  /// What makes the device act may take its time on another port.
  bool is_early(Time moment, const StepRecord& record) const {
    constexpr Duration margin = 100ms;
    return reason_for(record) - moment > margin;
  }

  void judge_opening(const PreparedStep& step, const StepRecord& record,
                     const results::Event* opened) {
    if (!opened)
      return findings_.miss(fmt::format("the device did not open a connection within {:.0f} ms",
                                        to_ms(record.deadline - record.cause)));
    const vectors::LinkSpec& due = step.step->link;
    if ((due.port != 0 || !due.protocol.empty()) && opened->port != step.port)
      return findings_.miss(fmt::format("the device opened a connection to TCP {}; {} is due",
                                        opened->port, step.port));
    if (is_early(opened->start, record))
      return findings_.miss(
          fmt::format("the device opened the connection {:.1f} ms before it had a reason to",
                      to_ms(reason_for(record) - opened->start)));
    judge_limit({"connection", "what it follows", step.step->within.has_value(),
                 record.deadline - record.cause, opened->start - record.cause},
                rules_, findings_);
  }

  /// What came just before the end of a wait may have come behind it, for all that the link tells.
  bool ends_too_close(const StepRecord& record, const Received& received) {
    if (received.arrivals.empty() || findings_.missed()) return false;
    const Duration before = record.cause - received.arrivals.front().start;
    if (before >= rules_.timing_floor) return false;
    findings_.result.received = received;
    too_close_ = fmt::format(
        "{} bytes came {:.1f} ms before the end of the silence{}: this link may make {:.1f} ms "
        "itself",
        received.bytes.size(), to_ms(before), on_link(received.link), to_ms(rules_.timing_floor));
    return true;
  }

  void judge_silence(const Received& received) {
    if (received.arrivals.empty() || findings_.missed()) return;
    findings_.result.received = received;
    findings_.miss(fmt::format("{} bytes came where silence is due{}: {}", received.bytes.size(),
                               on_link(received.link), notation::print_beginning(received.bytes)));
  }

  using Numbers = std::vector<std::optional<vectors::Number>>;

  static bool holds(const std::string& value, const std::string& due, const Numbers& numbers,
                    std::size_t i) {
    if (i < numbers.size() && numbers[i]) return numbers[i]->holds(value);
    return std::ranges::equal(value, due,
                              [](char a, char b) { return hex_digit(a) == hex_digit(b); });
  }

  /// What was read at the address of the i-th value; nothing: nobody could read it.
  static const std::string* held_at(const Step& step, const StepRecord& record, std::size_t i) {
    const auto held = std::ranges::find(record.memory, step.memory[i].first,
                                        &std::pair<std::string, std::string>::first);
    return held == record.memory.end() ? nullptr : &held->second;
  }

  bool fits(const Step& step, const StepRecord& record, const vectors::CheckedValues& one) const {
    for (std::size_t i = 0; i < step.memory.size(); ++i)
      if (const std::string* const value = held_at(step, record, i);
          value && !holds(*value, one.digits[i], one.numbers, i))
        return false;
    return true;
  }

  /// Of named alternatives the one that holds; nothing: none does.
  const vectors::CheckedValues* matching(const Step& step, const StepRecord& record) {
    std::vector<const vectors::CheckedValues*> fitting;
    for (const vectors::CheckedValues& one : step.alternatives)
      if (fits(step, record, one)) fitting.push_back(&one);
    if (fitting.empty()) return nullptr;
    const vectors::CheckedValues* const preferred = step.alternatives.data();
    // Where the preferred one is not told from another, nothing is known of the reading.
    if (fitting.front() != preferred || fitting.size() == 1)
      take(step.reading, fitting.front()->alternative, fitting.front() == preferred);
    return fitting.front();
  }

  void judge_memory(const Step& step, const StepRecord& record) {
    const vectors::CheckedValues* const match = matching(step, record);
    const Numbers& numbers = match ? match->numbers : step.numbers;
    for (std::size_t i = 0; i < step.memory.size(); ++i) {
      const auto& [address, preferred] = step.memory[i];
      const std::string& due = match ? match->digits[i] : preferred;
      const std::string* const value = held_at(step, record, i);
      if (!value)
        unread_.insert(address);
      else if (!holds(*value, due, numbers, i))
        missed_value(step, address, due, i < numbers.size() ? numbers[i] : std::nullopt, *value);
    }
  }

  void missed_value(const Step& step, const std::string& address, const std::string& due,
                    const std::optional<vectors::Number>& number, const std::string& value) {
    const std::string held_text = number ? number->text_of(value) : value;
    const std::string due_text = number ? number->text() : due;
    if (!findings_.missed())
      findings_.result.differences.push_back({address, due_text, held_text, ""});
    const std::string others =
        step.alternatives.empty()
            ? ""
            : fmt::format("; it is no alternative of {} either", step.reading);
    findings_.miss(fmt::format("{} holds {}, {} is due{}", address, held_text, due_text, others));
  }

  /// What no step was waiting for.
  void judge_surplus() {
    if (findings_.missed()) return;
    const Received& received = shares_.surplus.received;
    if (!received.arrivals.empty()) {
      findings_.result.received = received;
      const char* hint = protocol_.frame_length(received.bytes) == received.bytes.size()
                             ? " (a whole frame: do two devices have this station number?)"
                             : "";
      return findings_.miss(fmt::format("{} bytes after the complete exchange{}{}: {}",
                                        received.bytes.size(), on_link(received.link), hint,
                                        notation::print_beginning(received.bytes)));
    }
    if (const exchange::Ending& ending = shares_.surplus.ending)
      findings_.miss(in_words(ending) + ", which nothing in the case asks for");
  }

  const exchange::PreparedCase& prepared_;
  const exchange::Transcript& transcript_;
  const JudgeRules& rules_;
  const harness::Protocol& protocol_;
  bool client_;
  exchange::Shares shares_;
  Findings findings_;
  notation::Captures captures_;
  std::set<std::string> unread_;  // memory that was to be checked
  std::size_t record_ = 0;
  int looks_ = 0, passed_over_ = 0;         // at memory
  std::map<Bytes, const Received*> paced_;  // what came at the pace of a clock last
  Time waited_until_{};                     // the end of the last wait: nothing was due before
  std::string too_close_;                   // why nothing can be said from here on
};

}  // namespace

Judgement judge(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
                const JudgeRules& rules, const harness::Protocol& protocol) {
  return Judge(prepared, transcript, rules, protocol).judge();
}

}  // namespace fieldproof::judging
