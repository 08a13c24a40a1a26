#include "src/line/uart.hpp"

#include <algorithm>
#include <bit>

namespace fieldproof::line {

namespace {

constexpr Duration::rep second = 1'000'000'000;

/// The parity bit that a character of `data_bits` carries.
bool parity_bit(Byte value, const LineSettings& settings) {
  const unsigned data = value & (settings.data_bits == 7 ? 0x7Fu : 0xFFu);
  const bool odd_ones = std::popcount(data) % 2 != 0;
  return settings.parity == 'E' ? odd_ones : !odd_ones;
}

/// Bit 0 is the start bit.
bool bit_level(Byte value, int bit, const LineSettings& settings) {
  if (bit == 0) return false;
  if (bit <= settings.data_bits) return (value >> (bit - 1) & 1) != 0;
  if (settings.parity != 'N' && bit == settings.data_bits + 1) return parity_bit(value, settings);
  return true;
}

bool burst_level(const Burst& burst, const LineSettings& sender, Time t) {
  if (t < burst.start || t >= burst.end()) return true;
  const Duration since = t - burst.start;
  const auto index = static_cast<std::size_t>(since / burst.character_time);
  const auto bit = (since % burst.character_time).count() * sender.baud / second;
  return bit_level(burst.bytes[index], static_cast<int>(bit), sender);
}

/// The first start of a bit, or the end of the burst, at or after `from`.
std::optional<Time> bit_boundary(const Burst& burst, const LineSettings& sender, Time from) {
  if (from <= burst.start) return burst.start;
  if (from > burst.end()) return std::nullopt;
  const Duration since = from - burst.start;
  const Duration inside = since % burst.character_time;
  // The start of bit k in whole nanoseconds is rounded up, so that burst_level finds bit k there.
  const auto start_of = [&](Duration::rep bit) {
    return bit >= sender.bits_per_character()
               ? burst.character_time
               : Duration((bit * second + sender.baud - 1) / sender.baud);
  };
  const Duration::rep bit = inside.count() * sender.baud / second;
  return from - inside + (start_of(bit) == inside ? inside : start_of(bit + 1));
}

}  // namespace

void Waveform::add(const Burst& burst, const LineSettings& sender) {
  sources_.push_back({&burst, &sender});
}

void Waveform::mute(Time from, Time until) { muted_.push_back({from, until}); }

bool Waveform::high(Time t) const {
  if (std::ranges::any_of(muted_, [t](const Interval& m) { return t >= m.from && t < m.until; }))
    return true;
  return std::ranges::all_of(sources_,
                             [t](const Source& s) { return burst_level(*s.burst, *s.sender, t); });
}

std::optional<Time> Waveform::next_boundary(Time from) const {
  std::optional<Time> next;
  const auto consider = [&](std::optional<Time> t) {
    if (t && *t >= from && (!next || *t < *next)) next = t;
  };
  for (const Source& source : sources_) consider(bit_boundary(*source.burst, *source.sender, from));
  for (const Interval& interval : muted_) consider(interval.until);
  return next;
}

std::optional<Time> Waveform::falling_edge(Time from) const {
  for (auto t = next_boundary(from); t; t = next_boundary(*t + 1ns)) {
    if (!high(*t) && high(*t - 1ns)) return t;
  }
  return std::nullopt;
}

std::optional<Character> next_character(const Waveform& wave, const LineSettings& receiver,
                                        Time from) {
  const auto middle_of = [&](Time edge, int bit) {
    return edge + Duration((2 * bit + 1) * second / (2 * receiver.baud));
  };
  for (auto edge = wave.falling_edge(from); edge; edge = wave.falling_edge(from)) {
    from = middle_of(*edge, 0);
    if (wave.high(from)) continue;  // a glitch, not a start bit
    Character c{.start = *edge, .end = *edge + receiver.character_time()};
    int bit = 1;
    for (; bit <= receiver.data_bits; ++bit)
      c.value |= static_cast<Byte>(wave.high(middle_of(*edge, bit)) << (bit - 1));
    if (receiver.parity != 'N')
      c.parity_error = wave.high(middle_of(*edge, bit++)) != parity_bit(c.value, receiver);
    c.hunt_from = middle_of(*edge, bit);
    c.framing_error = !wave.high(c.hunt_from);
    return c;
  }
  return std::nullopt;
}

Reading read_burst(const Burst& burst, const LineSettings& sender, const LineSettings& receiver) {
  Reading reading;
  Burst sent = burst;
  drop_unsent_bits(sent.bytes, sender);
  if (sender == receiver) {
    reading.bursts.push_back(std::move(sent));
    return reading;
  }
  Waveform wave;
  wave.add(sent, sender);
  for (auto c = next_character(wave, receiver, burst.start); c;
       c = next_character(wave, receiver, c->hunt_from)) {
    reading.errors.parity += c->parity_error;
    reading.errors.framing += c->framing_error;
    if (!c->good()) continue;
    if (reading.bursts.empty() || reading.bursts.back().end() != c->start) {
      reading.bursts.push_back(
          {.bytes = {}, .start = c->start, .character_time = receiver.character_time()});
    }
    reading.bursts.back().bytes.push_back(c->value);
  }
  return reading;
}

void drop_unsent_bits(Bytes& bytes, const LineSettings& sender) {
  if (sender.data_bits != 7) return;
  for (Byte& b : bytes) b &= 0x7F;
}

}  // namespace fieldproof::line
