// How a case ends: what still belongs to it is heard, the device is asked whether it lives, what is
// open is closed.
#include "harness/exchange/case_run.hpp"

#include <algorithm>

namespace fieldproof::exchange {

using vectors::Step;

namespace {

bool has_probe(const Channel& to) { return !to.protocol->probe(to.station, {}).empty(); }

}  // namespace

void CaseRun::finish() {
  take_trace();
  const bool heard = transcript_.trouble || prepared_.runs_by_clock();  // it goes on asking
  const bool alive = heard || hear_the_rest();
  if (!prepared_.runs_by_clock()) links_.leave_over();
  close_links();
  if ((!alive || transcript_.flooded) && !transcript_.trouble) look_for_life();
}

/// Before what still belongs to the case is waited for.
void CaseRun::take_trace() {
  if (!prepared_.source->on_model.empty()) transcript_.trace = around_.device.endpoint->trace();
}

/// False: the device has not shown that it lives, although it was asked.
bool CaseRun::hear_the_rest() {
  const bool simulated = can().simulated;
  if (!simulated && prepared_.answers_probes()) return probe_links();
  const Time end = now() + (simulated ? around_.timing.promised_silence : around_.timing.quiet);
  while (links_.listen(*around_.device.endpoint, end)) {
  }
  return true;
}

/// Each link answers for itself: replies come in order on one link alone.
bool CaseRun::probe_links() {
  bool alive = false;
  for (Link& link : links_.all()) {
    if (link.to.endpoint != around_.device.endpoint || stopped()) continue;
    if (!link.network || (link.between_frames() && has_probe(link.to))) {
      alive = probe(link, std::nullopt) || alive;
      continue;
    }
    const Time end = link.last_sent.end + around_.timing.response_max;
    while (link.hears && links_.listen(link, end)) {
    }
  }
  return alive;
}

/// Sends a probe and takes out its reply; what came before that is the step's, or nobody's. False
/// when nothing came at all.
bool CaseRun::probe(Link& link, std::optional<int> step) {
  await_frame_gap(link);
  const harness::Protocol& protocol = *link.to.protocol;
  const Bytes request = protocol.probe(link.to.station, link.last_bytes);
  if (stopped()) return false;
  const std::optional<Sent> sent = links_.transmit(link, request, false);
  if (!sent) return false;
  const Time until = sent->end + around_.timing.response_max + prepared_.reply_delay;
  std::size_t before = 0, end = 0;  // of the last frame
  bool answered = false;
  while (!answered) {
    const ByteView came = link.pending.bytes();
    while (const auto length = protocol.frame_length(came.subspan(end))) {
      before = end;
      end += *length;
      answered = protocol.is_reply_to_probe(request, came.subspan(before, *length));
      if (answered) break;
    }
    if (answered || !link.hears || !links_.listen(link, until)) break;
  }
  if (!answered) hear_end(link);
  // A device that answers every request in a form of its own must still reach the case that names
  // the fault: replies come in order, so the last frame is its answer to the probe.
  if (!answered && end < link.pending.bytes().size()) {
    before = end;
    end = link.pending.bytes().size();
  }
  if (step)
    link.pending.give(before, *step, transcript_);
  else
    link.pending.leave_over(before, transcript_);
  // What comes behind the answer is the probe's, too: a device may spoil that one alone.
  link.pending.drop();
  links_.note(now(), answered ? "probe answered: nothing else was on its way"
                              : "probe not answered as expected");
  return end > 0;
}

/// What answers no probe and goes on, without a pause, for longer than the longest frame takes does
/// not end.
void CaseRun::hear_end(const Link& link) {
  const Time cut_off =
      now() + longest_reply(link.to.protocol->longest_frame(), link.to.endpoint->character_time());
  while (!link.pending.empty() && link.hears &&
         links_.listen(link, link.pending.last() + around_.timing.pause))
    transcript_.flooded = now() >= cut_off;
}

void CaseRun::look_for_life() {
  Channel device = around_.device;
  device.station = prepared_.station;
  if (transcript_.flooded && !implicit_transport(device)) {
    const Result<bool> silent =
        settle(*device.endpoint, around_.timing.pause, 3 * around_.timing.response_max);
    if (silent && !*silent) transcript_.dead = why_dead(Sign::endless);
    if (!silent) transcript_.trouble = silent.error();
    if (!silent || !*silent) return;
  }
  const Result<Sign> sign =
      Sanity(device, around_.timing)
          .anything_answers(3 * around_.timing.response_max, prepared_.reply_delay);
  if (!sign)
    transcript_.trouble = sign.error();
  else if (*sign != Sign::alive)
    transcript_.dead = why_dead(*sign);
}

/// What comes behind our FIN is nobody's: no late answer is credited to the next case.
void CaseRun::close_links() {
  for (Link& link : links_.all())
    if (link.network && link.sends && !link.gone) links_.close(link, Closing::fin);
  const Time end = now() + around_.timing.quiet;  // for the device to close its side
  const auto closing = [](const Link& link) { return link.network && link.hears && !link.sends; };
  while (std::ranges::any_of(links_.all(), closing) &&
         links_.listen(*around_.device.endpoint, end)) {
  }
}

Result<bool> CaseRun::is_asked(Duration patience) {
  for (const PreparedStep& one : prepared_.steps) {
    const Step::Kind kind = one.step->kind;
    if (kind == Step::Kind::expect || kind == Step::Kind::expect_open ||
        kind == Step::Kind::partner)
      break;
    if (kind != Step::Kind::set && kind != Step::Kind::act && kind != Step::Kind::wait) continue;
    step(one);
    if (!record().refused.empty()) return fail(record().refused);
  }
  const auto asked = [&] {
    return std::ranges::any_of(links_.all(),
                               [](const Link& link) { return !link.pending.empty(); });
  };
  const Time give_up = now() + patience;
  while (!asked() && links_.listen(*around_.device.endpoint, give_up)) {
  }
  if (transcript_.trouble) return *transcript_.trouble;
  // A clock goes on asking: there the next case drains the line.
  const bool came = asked();
  if (came && !prepared_.runs_by_clock()) {
    const Result<bool> settled =
        settle(*around_.device.endpoint, prepared_.client_settles() + around_.timing.quiet);
    if (!settled) return settled.error();
  }
  close_links();
  return came;
}

}  // namespace fieldproof::exchange
