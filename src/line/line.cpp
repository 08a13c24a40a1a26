#include "src/line/line.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace fieldproof::line {

namespace {
constexpr std::size_t bench = 0;

/// A device that asks this often at one moment never stops: a fault in the device.
constexpr int most_wakes_at_one_moment = 10'000;

bool overlap(const Burst& a, const Burst& b) { return a.start < b.end() && b.start < a.end(); }
}  // namespace

SimulatedLine::SimulatedLine(const LineSettings& bench_settings, Duplex duplex, Time now)
    : duplex_(duplex), now_(now) {
  listeners_.push_back({.settings = bench_settings, .heard = now});
}

void SimulatedLine::attach(Device& device, const LineSettings& settings) {
  listeners_.push_back({.device = &device, .settings = settings, .heard = now_});
  begin_transmission(listeners_.size() - 1, device.advance(now_));
}

SimulatedLine::Transmitted SimulatedLine::begin_to_transmit(ByteView bytes) {
  run(now_, false);
  begin_transmission(bench, Bytes(bytes.begin(), bytes.end()));
  return {now_, std::max(now_, listeners_[bench].transmits_until)};
}

SimulatedLine::Transmitted SimulatedLine::transmit(ByteView bytes) {
  const Transmitted sent = begin_to_transmit(bytes);
  run(sent.end, false);
  return sent;
}

Burst SimulatedLine::receive(Time until) {
  if (inbox_.empty()) run(std::max(until, now_), true);
  if (std::optional<Burst> burst = take_part()) return std::move(*burst);
  return {.bytes = {}, .start = now_, .character_time = bench_settings().character_time()};
}

std::optional<Burst> SimulatedLine::take() {
  if (inbox_.empty()) return std::nullopt;
  Burst burst = std::move(inbox_.front());
  inbox_.erase(inbox_.begin());
  return burst;
}

std::optional<Burst> SimulatedLine::take_part() {
  if (inbox_.empty()) hear(bench);
  return take();
}

std::optional<Time> SimulatedLine::next_event() const {
  const Time next = next_event(Time::max());
  return next == Time::max() ? std::nullopt : std::optional(next);
}

LineErrors SimulatedLine::take_errors() { return std::exchange(errors_, {}); }

void SimulatedLine::run(Time until, bool until_heard) {
  for (;;) {
    now_ = next_event(until);
    finish_transmissions();
    if (any_bit_exact_) {
      while (hear_characters()) {
      }
      forget_transmissions();
    }
    if (until_heard && !inbox_.empty())
      return;  // what is due at this moment happens first in the next call
    wake_stations();
    if (now_ == until) return;
  }
}

Time SimulatedLine::next_event(Time until) const {
  Time next = until;
  for (const OnAir& t : on_air_) {
    if (!t.over) next = std::min(next, t.burst.end());
  }
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    const Listener& l = listeners_[i];
    if (const auto wake = l.device ? l.device->wake_at() : std::nullopt)
      next = std::min(next, *wake);
    if (const auto character = l.bit_exact ? character_for(i) : std::nullopt)
      next = std::min(next, character->end);
  }
  return std::max(next, now_);
}

void SimulatedLine::finish_transmissions() {
  for (OnAir& t : on_air_) {
    if (t.over || t.burst.end() > now_) continue;
    for (std::size_t i = listeners_.size(); i-- > 0;)
      hear(i);  // the bench last: it takes the bytes away
    t.over = true;
  }
  if (!any_bit_exact_) std::erase_if(on_air_, [](const OnAir& t) { return t.over; });
}

/// Gives each bit-exact receiver its next character, if it is complete by now.
bool SimulatedLine::hear_characters() {
  bool any = false;
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    Listener& l = listeners_[i];
    if (!l.bit_exact) continue;
    const auto character = character_for(i);
    if (!character) l.hunt_from = std::max(l.hunt_from, now_);
    if (!character || character->end > now_) continue;
    any = true;
    l.hunt_from = character->hunt_from;
    if (character->good()) {
      deliver(i, {{character->value}, character->start, l.settings.character_time()});
    } else if (i == bench) {
      errors_.parity += character->parity_error;
      errors_.framing += character->framing_error;
    }
  }
  return any;
}

/// Drops the transmissions that no bit-exact receiver is inside of any more; on an idle line all
/// are fast again.
void SimulatedLine::forget_transmissions() {
  std::erase_if(on_air_, [this](const OnAir& t) {
    return t.over && std::ranges::none_of(listeners_, [&](const Listener& l) {
             return l.bit_exact && l.hunt_from < t.burst.end();
           });
  });
  if (!on_air_.empty()) return;
  any_bit_exact_ = false;
  for (Listener& l : listeners_) {
    l.bit_exact = false;
    l.heard = now_;
  }
}

void SimulatedLine::wake_stations() {
  for (std::size_t i = 1; i < listeners_.size(); ++i) {
    Device& device = *listeners_[i].device;
    for (int wakes = 0;; ++wakes) {
      const auto wake = device.wake_at();
      if (!wake || *wake > now_) break;
      if (hear(i)) continue;  // bytes that came before may have changed its plans
      if (wakes == most_wakes_at_one_moment) {
        throw std::logic_error("station " + std::to_string(i) + " asks to be woken at " +
                               std::to_string(now_.count()) +
                               " ns without end; its advance must move wake_at on");
      }
      begin_transmission(i, device.advance(now_));
    }
  }
}

void SimulatedLine::begin_transmission(std::size_t sender, Bytes bytes) {
  if (bytes.empty()) return;
  Listener& from = listeners_[sender];
  // Characters so far are heard as they are, before those in progress collide.
  if (!on_air_.empty()) {
    for (std::size_t i = 0; i < listeners_.size(); ++i) hear(i);
  }
  drop_unsent_bits(bytes, from.settings);
  const Time start =
      std::max(now_, from.transmits_until);  // behind what the station is still sending
  on_air_.push_back({sender,
                     {.bytes = std::move(bytes),
                      .start = start,
                      .character_time = from.settings.character_time()}});
  from.transmits_until = on_air_.back().burst.end();
  for (std::size_t i = 0; i < listeners_.size(); ++i) {
    Listener& l = listeners_[i];
    if (l.bit_exact || on_fast_path(i)) continue;
    l.bit_exact = any_bit_exact_ = true;
    l.hunt_from = l.heard;
  }
}

bool SimulatedLine::on_fast_path(std::size_t listener) const {
  for (const OnAir& t : on_air_) {
    if (t.sender == listener) continue;
    if (listeners_[t.sender].settings != listeners_[listener].settings) return false;
    for (const OnAir& other : on_air_) {
      const bool disturbs =
          other.sender != t.sender && (other.sender != listener || duplex_ == Duplex::half);
      if (disturbs && overlap(t.burst, other.burst)) return false;
    }
  }
  return true;
}

/// Fast path: gives the listener the characters that have ended by now. True when there were any.
bool SimulatedLine::hear(std::size_t listener) {
  Listener& l = listeners_[listener];
  if (l.bit_exact) return false;
  bool any = false;
  for (OnAir& t : on_air_) {
    Burst& burst = t.burst;
    if (t.sender == listener || t.over || now_ < burst.start + burst.character_time) continue;
    const auto size = static_cast<Duration::rep>(burst.bytes.size());
    const auto first = l.heard <= burst.start ? 0 : (l.heard - burst.start) / burst.character_time;
    const auto last = std::min(size, (now_ - burst.start) / burst.character_time);
    if (first >= last) continue;
    any = true;
    l.heard = burst.start + last * burst.character_time;
    const bool whole = first == 0 && last == size;
    if (whole && listener == bench && inbox_.empty() && !any_bit_exact_) {
      inbox_.push_back(std::move(burst));  // nobody needs it after the bench
    } else if (whole) {
      deliver(listener, burst);
    } else {
      part_.bytes.assign(burst.bytes.begin() + first, burst.bytes.begin() + last);
      part_.start = burst.start + first * burst.character_time;
      part_.character_time = burst.character_time;
      deliver(listener, part_);
    }
  }
  return any;
}

void SimulatedLine::deliver(std::size_t listener, const Burst& burst) {
  if (listener != bench) {
    listeners_[listener].device->receive(burst);
  } else if (!inbox_.empty() && inbox_.back().end() == burst.start &&
             inbox_.back().character_time == burst.character_time) {
    inbox_.back().bytes.insert(inbox_.back().bytes.end(), burst.bytes.begin(), burst.bytes.end());
  } else {
    inbox_.push_back(burst);
  }
}

/// The next character of a bit-exact receiver, as far as it is known who transmits.
std::optional<Character> SimulatedLine::character_for(std::size_t listener) const {
  const Listener& l = listeners_[listener];
  Waveform wave;
  for (const OnAir& t : on_air_) {
    if (t.sender != listener) {
      wave.add(t.burst, listeners_[t.sender].settings);
    } else if (duplex_ == Duplex::half) {
      wave.mute(t.burst.start, t.burst.end());
    }
  }
  return next_character(wave, l.settings, l.hunt_from);
}

}  // namespace fieldproof::line
