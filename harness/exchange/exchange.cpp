#include "harness/exchange/exchange.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace fieldproof::exchange {

using vectors::Step;

namespace {

/// More than any exchange of these protocols comes to: the device floods.
constexpr std::size_t flood_limit = 16'384;

/// No reply of these protocols is longer on the wire at the slowest speed: bytes that trickle in
/// for longer are no reply.
constexpr Duration longest_reply = 10s;

constexpr Duration restart_patience = 10s;
constexpr Duration settle_patience = 10s;

}  // namespace

Transcript Exchange::run(const PreparedCase& prepared) {
  Transcript transcript;
  transcript.steps.reserve(prepared.steps.size());
  captures_.clear();
  pending_ = {};
  last_bytes_.clear();
  partner_.emplace(protocol_);
  request_ = {};
  neighbours_ = prepared.source->config.contains("neighbours");
  // Memory that was given through the protocol may just have been answered.
  last_heard_ = stimulus_ = endpoint_.now();
  last_sent_ = {last_heard_, last_heard_};
  for (const PreparedStep& one : prepared.steps) {
    for (int i = 0; i < one.step->times; ++i) {
      step(prepared, one, transcript);
      if (transcript.trouble || transcript.flooded || !transcript.steps.back().refused.empty())
        return transcript;
    }
  }
  return transcript;
}

void Exchange::step(const PreparedCase& prepared, const PreparedStep& step,
                    Transcript& transcript) {
  StepRecord& record = transcript.steps.emplace_back();
  switch (step.step->kind) {
    case Step::Kind::send: return send(step, record, transcript);
    case Step::Kind::expect:
      await_frame(step, record, transcript);
      if (step.step->partner && !request_.bytes.empty())
        answer(prepared, *step.step->partner, record, transcript);
      return;
    case Step::Kind::partner: return partner(prepared, step, record, transcript);
    case Step::Kind::silence: return silence(prepared, record, transcript);
    case Step::Kind::wait:
      return wait_until(endpoint_.now() + step.step->duration, record, transcript);
    case Step::Kind::set:
    case Step::Kind::check: return access_memory(prepared, *step.step, record, transcript);
    case Step::Kind::act:
      if (const Status done = endpoint_.act(step.step->action); !done)
        record.refused = done.error().message;
      else if (step.step->action == "power_cycle" && endpoint_.capabilities().real_device)
        await_return(prepared, transcript);
      stimulus_ = endpoint_.now();
      return note("do " + step.step->action, transcript);
    case Step::Kind::open:
    case Step::Kind::close:
    case Step::Kind::expect_close:
      record.refused = "this endpoint has no link that opens and closes";
      return;
  }
}

/// A real device needs time to start again.
void Exchange::await_return(const PreparedCase& prepared, Transcript& transcript) {
  const Result<bool> back =
      anything_answers(prepared.station, restart_patience, prepared.reply_delay());
  if (!back) transcript.trouble = back.error();
}

void Exchange::send(const PreparedStep& step, StepRecord& record, Transcript& transcript) {
  await_frame_gap(transcript);
  // What came before this send belongs to what was open until now.
  while (listen(endpoint_.now(), transcript)) {
  }
  if (!pending_.bytes.empty() && transcript.surplus.bytes.empty()) {
    transcript.surplus = pending_.take(pending_.bytes.size());
    transcript.surplus_after = transcript.steps.size() - 1;
  }
  if (transcript.trouble || transcript.flooded) return;
  request_ = {};
  const notation::FrameTemplate& frame = step.frames.front().frame;
  const Result<Bytes> bytes = notation::render(frame, captures_);
  if (!bytes) {
    record.refused = bytes.error().message;
    return;
  }
  std::size_t from = 0;
  for (const notation::FrameTemplate::Gap& gap : frame.gaps) {
    if (gap.before > from &&
        !transmit(ByteView(*bytes).subspan(from, gap.before - from), transcript))
      return;
    from = gap.before;
    const Time moment = endpoint_.now() + gap.pause.at(endpoint_.character_time());
    while (listen(moment, transcript)) {
    }
    if (transcript.trouble) return;
  }
  if (from < bytes->size() && !transmit(ByteView(*bytes).subspan(from), transcript)) return;
  record.sent = last_sent_;
  record.sent_bytes = *bytes;
  last_bytes_ = *bytes;
}

void Exchange::await_frame(const PreparedStep& step, StepRecord& record, Transcript& transcript) {
  record.stimulus = stimulus_;
  record.deadline = stimulus_ + reply_limit(*step.step, timing_.response_max);
  const Time give_up = record.deadline + timing_.late_watch;
  const Time cut_off = give_up + longest_reply;
  std::size_t length = 0;
  while ((length = complete_length(step)) == 0) {
    const Time until =
        pending_.bytes.empty()
            ? give_up
            : std::max(record.deadline, pending_.arrivals.back().end + timing_.quiet);
    if (!listen(std::min(until, cut_off), transcript) || endpoint_.now() >= cut_off) break;
  }
  record.received = pending_.take(length ? length : pending_.bytes.size());
  record.listened_until = endpoint_.now();
  request_ = {};
  if (record.received.arrivals.empty()) return;
  stimulus_ = record.received.arrivals.back().end;
  const Duration each = endpoint_.character_time();
  request_ = {record.received.bytes,
              stimulus_ - each * static_cast<Duration::rep>(record.received.bytes.size()), each};
}

void Exchange::partner(const PreparedCase& prepared, const PreparedStep& step, StepRecord& record,
                       Transcript& transcript) {
  if (request_.bytes.empty()) await_frame(step, record, transcript);
  if (transcript.trouble || transcript.flooded) return;
  if (!request_.bytes.empty()) return answer(prepared, *step.step->partner, record, transcript);
  record.refused =
      fmt::format("no request within {:.0f} ms", to_ms(record.deadline - record.stimulus));
  record.refused_by_device = true;
}

void Exchange::answer(const PreparedCase& prepared, const vectors::PartnerSpec& spec,
                      StepRecord& record, Transcript& transcript) {
  const Burst request = std::exchange(request_, {});
  // Past the client's time-out, and past what the link can tell apart.
  const Duration more = endpoint_.character_time() + endpoint_.capabilities().timing_floor;
  const Result<Partner::Answer> reply =
      partner_->answer(spec, request, request.end() + prepared.client_time_out() + more);
  if (!reply) {
    record.refused = reply.error().message;
    return;
  }
  const std::string fault = spec.fault.empty() ? "" : fmt::format(" ({})", spec.fault);
  note(fmt::format("partner: {}{}", reply->bytes.empty() ? "no answer" : "answers", fault),
       transcript);
  if (reply->bytes.empty()) return;
  await_frame_gap(transcript);
  while (listen(reply->moment, transcript)) {
  }
  if (transcript.trouble || transcript.flooded || !transmit(reply->bytes, transcript)) return;
  record.sent = last_sent_;
  record.sent_bytes = reply->bytes;
}

/// How many of the pending bytes are a reply: what an alternative matches, else a complete frame of
/// the protocol.
std::size_t Exchange::complete_length(const PreparedStep& step) {
  if (pending_.bytes.empty()) return 0;
  bool could_grow = false;
  for (const PreparedFrame& one : step.frames) {
    const std::size_t size = one.frame.bytes.size();
    const ByteView head = ByteView(pending_.bytes).first(std::min(size, pending_.bytes.size()));
    notation::Captures captures = captures_;
    const std::optional<std::size_t> mismatch = notation::first_mismatch(one.frame, head, captures);
    if (!mismatch) {
      captures_ = std::move(captures);
      return size;
    }
    could_grow |= *mismatch == pending_.bytes.size() && pending_.bytes.size() < size;
  }
  if (could_grow) return 0;
  return protocol_.frame_length(pending_.bytes).value_or(0);
}

void Exchange::silence(const PreparedCase& prepared, StepRecord& record, Transcript& transcript) {
  if (endpoint_.capabilities().simulated)
    return wait_until(last_sent_.end + timing_.promised_silence, record, transcript);
  // A probe would change the counters, and a client answers none: there the time is waited out.
  if (prepared.looks_at_counters() || !prepared.answers_probes())
    return wait_until(last_sent_.end + timing_.response_max, record, transcript);
  if (!protocol_.frame_length(last_bytes_)) {
    // Without a tail the probe would be taken for more of the same frame until the inter-character
    // time is over.
    wait_until(last_sent_.end + timing_.quiet, record, transcript);
    if (transcript.trouble || !record.received.bytes.empty()) return;
  }
  if (!probe(prepared, record.received, transcript))
    wait_until(last_sent_.end + timing_.response_max, record, transcript);
  record.listened_until = endpoint_.now();
}

void Exchange::wait_until(Time moment, StepRecord& record, Transcript& transcript) {
  while (listen(moment, transcript)) {
  }
  record.received.append(std::exchange(pending_, {}));
  record.listened_until = endpoint_.now();
  note(fmt::format("{} until {:.1f} ms", record.received.bytes.empty() ? "silence" : "listened",
                   to_ms(record.listened_until)),
       transcript);
}

void Exchange::access_memory(const PreparedCase& prepared, const Step& step, StepRecord& record,
                             Transcript& transcript) {
  const bool setting = step.kind == Step::Kind::set;
  if (setting) stimulus_ = endpoint_.now();
  // A frame that nobody answers (the bench's own reply to a client) is still on its way when the
  // send returns.
  const bool unanswered = transcript.steps.size() > 1 &&
                          !transcript.steps[transcript.steps.size() - 2].sent_bytes.empty();
  if (!setting && unanswered && !endpoint_.capabilities().simulated) {
    const Time settled = last_sent_.end + timing_.quiet;
    while (listen(settled, transcript)) {
    }
  }
  for (const auto& [address, hex] : step.memory) {
    Status done = ok();
    if (setting) {
      done = memory_.set(prepared, address, hex);
      note(fmt::format("set {} = {}", address, hex), transcript);
    } else if (memory_.can_read(prepared, address)) {
      const Result<std::string> value = memory_.get(prepared, address, hex.size());
      if (value) record.memory.emplace_back(address, *value);
      if (value)
        note(fmt::format("check {}: {}", address, *value), transcript);
      else
        done = value.error();
    }
    if (done) continue;
    record.refused = done.error().message;
    record.refused_by_device = memory_.refused();
    return;
  }
}

void Exchange::close(const PreparedCase& prepared, Transcript& transcript) {
  if (transcript.trouble) return;
  if (prepared.runs_by_clock()) return;  // it goes on asking
  StepRecord rest;
  const bool simulated = endpoint_.capabilities().simulated;
  if (simulated || !prepared.answers_probes()) {
    wait_until(endpoint_.now() + (simulated ? timing_.promised_silence : timing_.quiet), rest,
               transcript);
    transcript.events.pop_back();
  } else if (!probe(prepared, rest.received, transcript) && !transcript.trouble) {
    if (const Result<bool> alive =
            anything_answers(prepared.station, 3 * timing_.response_max, prepared.reply_delay());
        !alive)
      transcript.trouble = alive.error();
    else if (!*alive)
      transcript.dead = "nothing answers any more";
  }
  if (rest.received.bytes.empty() || !transcript.surplus.bytes.empty()) return;
  transcript.surplus = std::move(rest.received);
  transcript.surplus_after = transcript.steps.size();
}

Result<bool> Exchange::anything_answers(int station, Duration patience, Duration reply_delay) {
  const Time begun = endpoint_.now();
  const Time give_up = begun + patience + reply_delay;
  Bytes heard;
  std::size_t probes = 0, answers = 0;
  if (protocol_.probe(station, {}).empty()) return true;
  while (endpoint_.now() < give_up) {
    const Result<Sent> sent = endpoint_.send(protocol_.probe(station, {}));
    if (!sent) return sent.error();
    ++probes;
    // A child that has just been started flushes what came before it opened the port: the first
    // probe is often lost.
    const bool maybe_lost = probes == 1 && endpoint_.capabilities().can_power_cycle;
    Time until = std::min(
        give_up, sent->end + (maybe_lost ? timing_.quiet : timing_.response_max) + reply_delay);
    while (answers < probes) {
      const Result<Burst> burst = endpoint_.receive(until);
      if (!burst) return burst.error();
      if (burst->bytes.empty()) break;
      heard.insert(heard.end(), burst->bytes.begin(), burst->bytes.end());
      if (heard.size() > flood_limit) return true;
      answers += take_frames(heard);
      // Answers to earlier probes may still be on their way: as long as the first one took, and
      // never mid-frame.
      const Duration slowness = endpoint_.now() - begun;
      until =
          endpoint_.now() + (heard.empty() ? std::max<Duration>(timing_.quiet, slowness)
                                           : std::max<Duration>(timing_.response_max, slowness));
    }
    if (answers > 0 || !heard.empty()) return true;
  }
  return false;
}

Result<bool> Exchange::anything_is_asked(const PreparedCase& prepared, Duration patience) {
  Transcript transcript;
  pending_ = {};
  for (const PreparedStep& one : prepared.steps) {
    const Step::Kind kind = one.step->kind;
    if (kind == Step::Kind::expect || kind == Step::Kind::partner) break;
    if (kind == Step::Kind::set || kind == Step::Kind::act || kind == Step::Kind::wait)
      step(prepared, one, transcript);
    if (!transcript.steps.empty() && !transcript.steps.back().refused.empty())
      return fail(transcript.steps.back().refused);
  }
  const bool asked = listen(endpoint_.now() + patience, transcript);
  pending_ = {};
  if (transcript.trouble) return *transcript.trouble;
  // A clock goes on asking: there the next case drains the line.
  if (!asked || prepared.runs_by_clock()) return asked;
  const Status settled = settle(prepared.client_time_out() + timing_.quiet);
  return settled ? Result<bool>(true) : settled.error();
}

Status Exchange::settle(Duration silence) {
  Transcript transcript;
  const Time give_up = endpoint_.now() + settle_patience;
  while (endpoint_.now() < give_up && listen(endpoint_.now() + silence, transcript)) {
  }
  pending_ = {};
  return transcript.trouble ? Status(*transcript.trouble) : ok();
}

Result<results::ResponseTimes> Exchange::time_probes(int station, int count, Duration budget) {
  results::ResponseTimes times;
  const Bytes request = protocol_.probe(station, {});
  const Time give_up = endpoint_.now() + budget;
  bool late = false;  // then what comes next would be taken for the answer to another probe
  for (int i = 0; i < count && !late && !request.empty() && endpoint_.now() < give_up; ++i) {
    Transcript transcript;
    while (listen(endpoint_.now(), transcript)) {
    }  // what is left of the answer before
    await_frame_gap(transcript);
    pending_ = {};
    if (!transcript.trouble && transmit(request, transcript)) {
      const Time until = last_sent_.end + timing_.response_max;
      while (!protocol_.frame_length(pending_.bytes) && listen(until, transcript)) {
      }
    }
    if (transcript.trouble) return *transcript.trouble;
    late = pending_.bytes.empty();
    if (!late) times.add(to_ms(pending_.arrivals.front().start - last_sent_.end));
  }
  // Late or second answers are not for the first case to find.
  if (const Status quiet = settle(late ? timing_.late_watch : timing_.quiet); !quiet)
    return quiet.error();
  return times;
}

/// Takes complete frames off the front; how many.
std::size_t Exchange::take_frames(Bytes& bytes) const {
  std::size_t count = 0;
  for (; const std::optional<std::size_t> length = protocol_.frame_length(bytes); ++count)
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(*length));
  return count;
}

bool Exchange::probe(const PreparedCase& prepared, Received& before, Transcript& transcript) {
  await_frame_gap(transcript);
  const Bytes request = protocol_.probe(prepared.station, last_bytes_);
  const Result<Sent> sent = endpoint_.send(request);
  if (!sent) {
    transcript.trouble = sent.error();
    return false;
  }
  transcript.events.push_back({results::Event::Kind::sent, sent->start, sent->end, request, {}});
  std::vector<Received> frames;
  bool answered = false;
  while (!answered) {
    while (const std::optional<std::size_t> length = protocol_.frame_length(pending_.bytes)) {
      frames.push_back(pending_.take(*length));
      answered = protocol_.is_reply_to_probe(request, frames.back().bytes);
      if (answered) break;
    }
    if (answered || !listen(sent->end + timing_.response_max + prepared.reply_delay(), transcript))
      break;
  }
  // A device that answers every request in a form of its own must still reach the case that names
  // the fault: replies come in order, so the last frame is its answer to the probe.
  if (!pending_.bytes.empty() && !answered) frames.push_back(pending_.take(pending_.bytes.size()));
  const bool alive = !frames.empty();
  if (alive) frames.pop_back();
  for (Received& frame : frames) before.append(std::move(frame));
  note(answered ? "probe answered: nothing else was on its way" : "probe not answered as expected",
       transcript);
  return alive;
}

void Exchange::await_frame_gap(Transcript& transcript) {
  const Duration gap = protocol_.frame_gap(endpoint_.character_time());
  if (gap == 0ns) return;
  const auto end = [&] {
    // Without a wire a frame ends later. Who has answered has seen the end of it, but its
    // neighbours heard the answer.
    const bool seen = last_heard_ >= last_sent_.end && !neighbours_;
    if (!endpoint_.capabilities().wire)
      return std::max(last_sent_.end, last_heard_) + (seen ? 0ns : timing_.quiet);
    return std::max(last_sent_.end, last_heard_) + gap;
  };
  while (listen(end(), transcript)) {
  }
}

bool Exchange::transmit(ByteView bytes, Transcript& transcript) {
  const Result<Sent> sent = endpoint_.send(bytes);
  if (!sent) {
    transcript.trouble = sent.error();
    return false;
  }
  last_sent_ = *sent;
  stimulus_ = sent->end;
  const int step = static_cast<int>(transcript.steps.size()) - 1;
  transcript.events.push_back({results::Event::Kind::sent,
                               sent->start,
                               sent->end,
                               Bytes(bytes.begin(), bytes.end()),
                               {},
                               step});
  return true;
}

bool Exchange::listen(Time deadline, Transcript& transcript) {
  if (transcript.trouble || transcript.flooded) return false;
  Result<Burst> burst = endpoint_.receive(deadline);
  if (!burst) {
    transcript.trouble = burst.error();
    return false;
  }
  if (burst->bytes.empty()) return false;
  pending_.add(*burst, transcript.events.size());
  last_heard_ = burst->end();
  transcript.flooded = pending_.bytes.size() > flood_limit;
  transcript.events.push_back(
      {results::Event::Kind::received, burst->start, burst->end(), std::move(burst->bytes), {}});
  return !transcript.flooded;
}

void Exchange::note(std::string text, Transcript& transcript) {
  const Time now = endpoint_.now();
  transcript.events.push_back({results::Event::Kind::note, now, now, {}, std::move(text)});
}

}  // namespace fieldproof::exchange
