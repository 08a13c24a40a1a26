#include "harness/exchange/sanity.hpp"

#include <algorithm>

namespace fieldproof::exchange {

namespace {

bool has(ByteView bytes, ByteView part) { return !std::ranges::search(bytes, part).empty(); }

}  // namespace

Result<Sign> Sanity::anything_answers(Duration patience, Duration reply_delay, bool starting) {
  const endpoints::Endpoint& endpoint = *device_.endpoint;
  const Bytes request = device_.protocol->probe(device_.station, {});
  if (request.empty()) return Sign::alive;
  const Time begun = endpoint.now(), give_up = begun + patience + reply_delay;
  Sign sign = Sign::silent;
  heard_.clear();
  all_.clear();
  probes_ = answers_ = 0;
  // A child that has just been started flushes what came before it opened the port: the first
  // probes are often lost.
  Duration patient = endpoint.capabilities().can_power_cycle ? timing_.quiet : timing_.response_max;
  for (; endpoint.now() < give_up; patient = std::min(2 * patient, timing_.response_max)) {
    const Result<Sent> sent = visit_.send(request);
    if (!sent) return sent.error();
    ++probes_;
    const Status listened =
        hear_answers(std::min(give_up, sent->end + patient + reply_delay), begun);
    if (!listened) return listened.error();
    if (endless_) return Sign::endless;
    if (answers_ > 0 || !heard_.empty()) return Sign::alive;
    if (!visit_.ended()) continue;
    sign = visit_.refused() ? Sign::refused : Sign::ended;
    probes_ = 0;
    if (sign == Sign::refused && !starting && !endpoint.capabilities().can_power_cycle) break;
    if (const Status waited = visit_.pause(timing_.quiet); !waited) return waited.error();
  }
  return sign;
}

/// Until as many answers have come as were asked for, and never ends in mid-frame.
Status Sanity::hear_answers(Time until, Time begun) {
  const Time cut_off =
      until + longest_reply(device_.protocol->longest_frame(), device_.endpoint->character_time());
  endless_ = false;
  while (answers_ < probes_) {
    const Result<Burst> burst = visit_.receive(until);
    if (!burst) return burst.error();
    endless_ = device_.endpoint->now() >= cut_off && !heard_.empty() && answers_ == 0;
    if (burst->bytes.empty()) return ok();
    heard_.insert(heard_.end(), burst->bytes.begin(), burst->bytes.end());
    if (all_.size() < flood_limit)
      all_.insert(all_.end(), burst->bytes.begin(), burst->bytes.end());
    endless_ = heard_.size() > flood_limit;
    if (endless_) return ok();
    answers_ += take_frames(heard_);
    // Answers to earlier probes may still be on their way: as long as the first one took.
    const Time now = device_.endpoint->now();
    until = std::min(now + std::max<Duration>(heard_.empty() ? timing_.quiet : timing_.response_max,
                                              now - begun),
                     cut_off);
    if (now >= cut_off) return ok();
  }
  return ok();
}

/// Takes complete frames off the front; how many.
std::size_t Sanity::take_frames(Bytes& bytes) const {
  std::size_t count = 0;
  for (; const auto length = device_.protocol->frame_length(bytes); ++count)
    bytes.erase(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(*length));
  return count;
}

/// Takes what is left of the answer before, and keeps the silence that a request needs before it.
Status Sanity::before_probe(Time last) {
  const endpoints::Endpoint& endpoint = *device_.endpoint;
  const Duration gap = endpoint.capabilities().wire
                           ? device_.protocol->frame_gap(endpoint.character_time())
                           : Duration{};
  for (std::size_t heard = 0; heard <= flood_limit;) {
    const Result<Burst> burst = visit_.receive(std::max(endpoint.now(), last + gap));
    if (!burst) return burst.error();
    if (burst->bytes.empty()) return ok();
    heard += burst->bytes.size();
    last = burst->end();
  }
  return ok();
}

/// Nothing: no answer in time. `last` is when the last of it came.
Result<std::optional<Duration>> Sanity::time_probe(ByteView request, Time& last) {
  if (const Status silent = before_probe(last); !silent) return silent.error();
  const Result<Sent> sent = visit_.send(request);
  if (!sent) return sent.error();
  std::optional<Duration> took;
  for (Bytes heard; heard.size() <= flood_limit && !device_.protocol->frame_length(heard);) {
    const Result<Burst> burst = visit_.receive(sent->end + timing_.response_max);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) break;
    if (!took) took = burst->start - sent->end;
    last = burst->end();
    heard.insert(heard.end(), burst->bytes.begin(), burst->bytes.end());
  }
  return took;
}

/// Of one more probe.
Result<bool> Sanity::comes_back(ByteView request, Time& last) {
  if (const Status silent = before_probe(last); !silent) return silent.error();
  const Result<Sent> sent = visit_.send(request);
  if (!sent) return sent.error();
  Bytes heard;
  while (heard.size() <= flood_limit && !has(heard, request)) {
    const Result<Burst> burst = visit_.receive(sent->end + timing_.response_max);
    if (!burst) return burst.error();
    if (burst->bytes.empty()) break;
    last = burst->end();
    heard.insert(heard.end(), burst->bytes.begin(), burst->bytes.end());
  }
  return has(heard, request);
}

Result<Sign> Sanity::first_sign(Duration patience) {
  const Result<Sign> sign = anything_answers(patience);
  const Bytes request = device_.protocol->probe(device_.station, {});
  if (!sign || *sign != Sign::alive || request.empty() || !has(all_, request) ||
      device_.protocol->reply_repeats(request))
    return sign;
  Time last{};
  for (int again = 0; again < 2; ++again) {
    const Result<bool> back = comes_back(request, last);
    if (!back) return back.error();
    if (*back) continue;
    const Result<bool> quiet = settle(*device_.endpoint, timing_.quiet);
    return quiet ? sign : quiet.error();
  }
  return Sign::echo;
}

Result<results::ResponseTimes> Sanity::time_probes(int count, Duration budget) {
  results::ResponseTimes times;
  const endpoints::Endpoint& endpoint = *device_.endpoint;
  const Bytes request = device_.protocol->probe(device_.station, {});
  const Time give_up = endpoint.now() + budget;
  bool late = false;  // then what comes next would be taken for the answer to another probe
  Time last{};
  for (int i = 0; i < count && !late && !request.empty() && endpoint.now() < give_up; ++i) {
    const Result<std::optional<Duration>> took = time_probe(request, last);
    if (!took) return took.error();
    late = !*took;
    if (*took) times.add(to_ms(**took));
  }
  // Late or second answers are not for the first case to find.
  if (const Result<bool> quiet =
          settle(*device_.endpoint, late ? timing_.late_watch : timing_.quiet);
      !quiet)
    return quiet.error();
  return times;
}

std::string why_dead(Sign sign) {
  switch (sign) {
    case Sign::refused: return "it refuses every connection";
    case Sign::ended: return "it closes every connection without an answer";
    case Sign::endless: return "it sends without end";
    default: return "nothing answers any more";
  }
}

Result<bool> settle(endpoints::Endpoint& endpoint, Duration silence, Duration patience) {
  const Time give_up = endpoint.now() + patience;
  for (std::size_t heard = 0; endpoint.now() < give_up && heard <= flood_limit;) {
    const Result<Burst> burst = endpoint.receive(endpoint.now() + silence);
    if (!burst) return burst.error();
    if (is_nothing(*burst)) return true;
    heard += burst->bytes.size();
  }
  return false;
}

}  // namespace fieldproof::exchange
