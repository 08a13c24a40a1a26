#include "harness/exchange/case_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "harness/exchange/p2p_blocks.hpp"
#include "harness/exchange/timing.hpp"

namespace fieldproof::exchange {

using vectors::Step;

CaseRun::CaseRun(const Surroundings& around, const PreparedCase& prepared)
    : around_(around),
      prepared_(prepared),
      client_(prepared.is_client()),
      neighbours_(prepared.source->config.contains("neighbours")),
      links_(transcript_),
      memory_(around.device, around.timing.response_max, around.aux, around.arming,
              [this](Burst burst) { links_.take(*around_.device.endpoint, std::move(burst)); }),
      partner_(*around.device.protocol) {
  transcript_.steps.reserve(prepared.steps.size());
  begin();
}

void CaseRun::begin() {
  const Channel own{around_.device.endpoint, around_.device.protocol, prepared_.station};
  const std::optional<Transport> transport = implicit_transport(own);
  if (!transport) {
    links_.add_line({}, own);
  } else if (client_) {
    const bool datagrams = asks_by_datagrams(prepared_.source->config);
    links_.await_device(own, datagrams ? Transport::udp : Transport::tcp);
  } else if (prepared_.implicit_link) {
    links_.open({}, own, *transport, own.protocol->port_for(*transport));
  }
  if (around_.aux) links_.add_line("aux", around_.aux);
}

void CaseRun::execute() {
  note_counters();
  for (const PreparedStep& one : prepared_.steps) {
    for (int i = 0; i < one.step->times && !stopped(); ++i) {
      step(one);
      if (is_missing(one) || !record().refused.empty()) return;
    }
  }
}

/// The device has not opened it: what follows is said on a link that is not there.
bool CaseRun::is_missing(const PreparedStep& step) {
  const Link* const link = links_.find(step.link);
  return (step.step->kind == Step::Kind::expect_open && !link) ||
         (step.step->kind == Step::Kind::expect && link && link->id == not_there);
}

void CaseRun::step(const PreparedStep& step) {
  transcript_.steps.emplace_back();
  switch (step.step->kind) {
    case Step::Kind::send: return send(step);
    case Step::Kind::expect:
      await_frame(step);
      if (step.step->partner && !links_.find(step.link)->request.bytes.empty()) answer(step);
      return;
    case Step::Kind::partner: return partner(step);
    case Step::Kind::silence: return silence(step);
    case Step::Kind::wait:
      record().cause = now() + step.step->duration;
      wait_until(record().cause, nullptr);
      return;
    case Step::Kind::set: return set_memory(step.step->memory);
    case Step::Kind::check: return look_at_memory(step);
    case Step::Kind::act: return act(step.step->action);
    case Step::Kind::open: return open(step);
    case Step::Kind::close: return close(step);
    case Step::Kind::expect_close: return await_ending(step);
    case Step::Kind::expect_open: return await_opening(step);
  }
}

void CaseRun::send(const PreparedStep& step) {
  Link& link = *links_.find(step.link);
  repeat_behind_lost_probe(link);
  last_sent_ = &step;
  await_frame_gap(link);
  // What came before this send belongs to what was open until now.
  while (links_.listen(link, now())) {
  }
  link.pending.leave_over();
  if (stopped()) return;
  link.request = {};
  const notation::FrameTemplate& frame = step.frames.front().frame;
  const Result<Bytes> bytes = notation::render(frame, captures_);
  if (!bytes) {
    record().refused = bytes.error().message;
    return;
  }
  if (send_pieces(link, frame, *bytes)) link.last_bytes = *bytes;
}

/// A pause ends a segment where there are such.
bool CaseRun::send_pieces(Link& link, const notation::FrameTemplate& frame, ByteView bytes) {
  std::size_t from = 0;
  last_sender_ = &link;
  last_sending_ = index();
  for (const notation::FrameTemplate::Gap& gap : frame.gaps) {
    if (gap.before > from && !links_.transmit(link, bytes.subspan(from, gap.before - from)))
      return false;
    from = gap.before;
    const Time moment = now() + gap.pause.at(link.to.endpoint->character_time());
    while (links_.listen(link, moment)) {
    }
    if (transcript_.trouble) return false;
  }
  const bool whole = link.datagrams() && bytes.empty();  // an empty datagram
  if (from == bytes.size() && !whole) return true;
  return links_.transmit(link, bytes.subspan(from)).has_value();
}

void CaseRun::await_frame_gap(const Link& link) {
  const endpoints::Endpoint& endpoint = *link.to.endpoint;
  const Duration gap = link.to.protocol->frame_gap(endpoint.character_time());
  if (gap == 0ns) return;
  const auto end = [&] {
    // Without a wire a frame ends later. Who has answered has seen the end of it, but its
    // neighbours heard the answer.
    const bool seen = link.last_heard >= link.last_sent.end && !neighbours_;
    if (!endpoint.capabilities().wire)
      return std::max(link.last_sent.end, link.last_heard) + (seen ? 0ns : around_.timing.quiet);
    return std::max(link.last_sent.end, link.last_heard) + gap;
  };
  while (links_.listen(link, end())) {
  }
}

void CaseRun::await_frame(const PreparedStep& step) {
  Link* link = links_.find(step.link);
  record().cause = link->cause;
  record().deadline = link->cause + prepared_.reply_limit(*step.step, around_.timing.response_max);
  const Time give_up = record().deadline + around_.timing.late_watch;
  const Time cut_off = give_up + longest_reply(link->to.protocol->longest_frame(),
                                               link->to.endpoint->character_time());
  std::optional<std::size_t> length;
  while (!(length = complete(step, *link))) {
    const bool next_may_come = link->by_device && link->name.empty();  // another connection
    if (!link->hears && !next_may_come) break;
    const Time until =
        link->pending.empty()
            ? give_up
            : std::max(record().deadline, link->pending.last() + around_.timing.quiet);
    const bool heard = links_.listen(*link, std::min(until, cut_off));
    if (link->to.endpoint->now() >= cut_off) transcript_.flooded = true;
    if (!heard || transcript_.flooded) break;
    link = links_.find(step.link);
  }
  take_frame(*link, length);
}

/// Nothing: it is not complete, and all that came is taken, and how the link ended.
void CaseRun::take_frame(Link& link, std::optional<std::size_t> length) {
  link.request = {};
  link.asked = link.asked && link.pending.empty();
  if (!length && link.ending && !(link.by_device && link.name.empty())) {
    (*link.ending)->step = index();
    link.ending.reset();
  }
  if (link.pending.empty()) return;
  const Bytes& all = link.pending.bytes();
  const std::size_t count = length.value_or(all.size());
  const Bytes bytes(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  link.cause = link.datagrams() ? link.pending.give_front(index())
                                : link.pending.give(count, index(), transcript_);
  const Duration each = link.to.endpoint->character_time();
  link.request = {bytes, link.cause - each * static_cast<Duration::rep>(count), each, link.id};
}

/// How many of the pending bytes are what the step waits for: what an alternative matches, else a
/// complete frame of the protocol, or a whole datagram. Nothing: more must come.
std::optional<std::size_t> CaseRun::complete(const PreparedStep& step, const Link& link) {
  if (link.pending.empty()) return std::nullopt;
  const ByteView came = link.datagrams() ? link.pending.front() : ByteView(link.pending.bytes());
  bool could_grow = false;
  for (const PreparedFrame& one : step.frames) {
    const std::size_t size = one.frame.bytes.size();
    const ByteView head = link.datagrams() ? came : came.first(std::min(size, came.size()));
    notation::Captures captures = captures_;
    const std::optional<std::size_t> mismatch = notation::first_mismatch(one.frame, head, captures);
    if (!mismatch) {
      captures_ = std::move(captures);
      return size;
    }
    could_grow |= *mismatch == came.size() && came.size() < size;
  }
  if (link.datagrams()) return came.size();
  if (could_grow) return std::nullopt;
  return link.to.protocol->frame_length(came);
}

void CaseRun::partner(const PreparedStep& step) {
  if (links_.find(step.link)->request.bytes.empty()) await_frame(step);
  if (stopped()) return;
  if (!links_.find(step.link)->request.bytes.empty()) return answer(step);
  record().refused =
      fmt::format("no request within {:.0f} ms", to_ms(record().deadline - record().cause));
  record().refused_by_device = true;
}

void CaseRun::answer(const PreparedStep& step) {
  Link& link = *links_.find(step.link);
  const Burst request = std::exchange(link.request, {});
  // Past the client's time-out, and past what the link can tell apart.
  const Duration more = link.to.endpoint->character_time() + can().timing_floor +
                        (can().simulated ? Duration{} : near_the_time_out);
  const vectors::PartnerSpec& spec = *step.step->partner;
  const Result<Partner::Answer> reply =
      partner_.answer(spec, request, request.end() + prepared_.client_time_out() + more);
  if (!reply) {
    record().refused = reply.error().message;
    return;
  }
  const std::string fault = spec.fault.empty() ? "" : fmt::format(" ({})", spec.fault);
  links_.note(now(),
              fmt::format("partner: {}{}", reply->bytes.empty() ? "no answer" : "answers", fault));
  if (reply->bytes.empty()) return;
  await_frame_gap(link);
  while (links_.listen(link, reply->moment)) {
  }
  if (stopped()) return;
  last_sender_ = &link;
  last_sending_ = index();
  links_.transmit(link, reply->bytes);
}

void CaseRun::silence(const PreparedStep& step) {
  Link& link = *links_.find(step.link);
  if (step.step->within) {
    wait_until(now() + *step.step->within, &link);
    return;
  }
  const Time due = link.last_sent.end + (can().simulated ? around_.timing.promised_silence
                                                         : around_.timing.response_max);
  // A probe would change the counters, and a client answers none; in the midst of a stream of bytes
  // it would be taken for more of the same frame. There the time is waited out.
  const bool probes =
      !can().simulated && !prepared_.looks_at_counters() && prepared_.answers_probes();
  const bool unended = probes && !link.network && !link.to.protocol->frame_length(link.last_bytes);
  if (!probes || (link.network && !link.between_frames()) || (unended && goes_on(step, link))) {
    wait_until(due, &link);
    return;
  }
  // Without a tail the probe would be taken for more of the same frame until the inter-character
  // time is over.
  if (unended && wait_until(link.last_sent.end + around_.timing.quiet, &link)) return;
  if (transcript_.trouble) return;
  if (!probe(link, index()) && !wait_until(due, &link)) lost_probe_ = last_sent_;
}

/// Of an unended frame: does no pause end it, and is what follows more of it? A probe would begin
/// another one between them.
bool CaseRun::goes_on(const PreparedStep& silence, const Link& link) const {
  const harness::Protocol& protocol = *link.to.protocol;
  if (protocol.frame_gap(1ms) > 0ns) return false;
  const PreparedStep* const end = prepared_.steps.data() + prepared_.steps.size();
  const auto* const next = std::find_if(&silence + 1, end, [&](const PreparedStep& later) {
    return later.step->kind == Step::Kind::send && later.link == silence.link;
  });
  const Bytes probe = protocol.probe(link.to.station, link.last_bytes);
  return next != end && !probe.empty() && !next->frames.front().frame.bytes.empty() &&
         next->frames.front().frame.bytes.front() != probe.front();
}

/// A device that loses the frame behind one that it passes over has lost the probe. What was sent
/// goes out again, and its silence is waited out, so that the case's own next request shows it.
void CaseRun::repeat_behind_lost_probe(Link& link) {
  const PreparedStep* const stimulus = std::exchange(lost_probe_, nullptr);
  if (!stimulus || stimulus->link != link.name) return;
  links_.note(now(), "a probe may have been lost: what was before it once more, without one");
  send(*stimulus);
  wait_until(link.last_sent.end + around_.timing.response_max, &link);
}

/// What came on the link (nullptr: on any) is the step's. Did anything?
bool CaseRun::wait_until(Time moment, Link* only) {
  endpoints::Endpoint& heard = only ? *only->to.endpoint : *around_.device.endpoint;
  while (links_.listen(heard, moment)) {
  }
  bool came = false;
  for (Link& link : links_.all()) {
    if (only && only != &link) continue;
    while (!link.pending.empty()) {
      link.pending.give_front(index());
      came = true;
    }
  }
  const Time end = heard.now();
  links_.note(end, came ? "listened until here" : "silence until here");
  return came;
}

}  // namespace fieldproof::exchange
