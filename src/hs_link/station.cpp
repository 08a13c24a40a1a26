#include "src/hs_link/station.hpp"

#include <algorithm>

#include "src/plc/counters.hpp"

namespace fieldproof::hs_link {

Station::Station(const plc::PlcModel& model, Parameter parameter, bool run)
    : memory_(model), parameter_(std::move(parameter)), run_(run) {
  heard_.resize(parameter_.blocks.size());
}

void Station::begin(Time now) {
  begun_ = true;
  if (works()) next_sending_ = now + parameter_.period;  // DECISIONS.md hslink/first-exchange
}

void Station::enable(bool enabled) {
  parameter_.enabled = enabled;
  forget();
}

void Station::power(bool on) {
  powered_ = on;
  sent_ = received_ = 0;
  forget();
}

void Station::forget() {
  heard_.assign(parameter_.blocks.size(), {});
  next_sending_.reset();
  was_well_ = begun_ = false;
}

Duration Station::patience() const { return std::max<Duration>(3 * parameter_.period, 100ms); }

bool Station::is_heard(const Heard& heard, Time now) const {
  return heard.at && now < *heard.at + patience();
}

std::optional<Time> Station::wake_at() const {
  if (!begun_) return Time{};
  std::optional<Time> first = next_sending_;
  for (const Heard& heard : heard_)
    if (heard.at) first = std::min(first.value_or(Time::max()), *heard.at + patience());
  return first;
}

std::vector<Broadcast> Station::advance(Time now) {
  std::vector<Broadcast> sent;
  if (!begun_) begin(now);
  for (Heard& heard : heard_)
    if (!is_heard(heard, now)) heard = {};
  if (!next_sending_ || now < *next_sending_) return sent;
  *next_sending_ += parameter_.period;
  for (std::size_t k = 0; k < parameter_.blocks.size(); ++k) {
    const Block& block = parameter_.blocks[k];
    if (!block.sends) continue;
    sent.push_back(broadcast_of(block));
    ++sent_;
    heard_[k] = {now, run_, error_, true};
  }
  return sent;
}

bool Station::communicates() const {
  return std::ranges::all_of(heard_, [](const Heard& heard) { return heard.at.has_value(); });
}

Broadcast Station::broadcast_of(const Block& block) const {
  Broadcast one{parameter_.station, block.number, run_, error_, false, {}};
  for (unsigned i = 0; i < block.words; ++i)
    one.words.push_back(static_cast<std::uint16_t>(memory_.read(block.area + i)));
  return one;
}

void Station::hear(const Broadcast& sent, Time now) {
  if (!works()) return;
  for (std::size_t k = 0; k < parameter_.blocks.size(); ++k) {
    const Block& block = parameter_.blocks[k];
    if (!takes(block, sent)) continue;
    heard_[k] = {now, sent.run, sent.error, sent.communicates};
    save(block, sent.words);
  }
}

void Station::count(const Broadcast& sent) {
  if (works() && std::ranges::any_of(parameter_.blocks,
                                     [&](const Block& block) { return takes(block, sent); }))
    ++received_;
}

Result<std::string> Station::get(std::string_view name, std::size_t digits) const {
  if (name == "@sent") return plc::counter_text(sent_, digits);
  if (name == "@received") return plc::counter_text(received_, digits);
  return plc::get_by_name(memory_, name, digits);
}

/// As far as both reach (DECISIONS.md hslink/sizes).
void Station::save(const Block& block, const std::vector<std::uint16_t>& words) {
  for (unsigned i = 0; i < block.words && i < words.size(); ++i)
    memory_.write(block.area + i, words[i]);
}

void Station::show(Flag flag, bool on, unsigned block) {
  memory_.write(flag_address(memory_.model(), parameter_.link, flag, block), on);
}

/// What is not heard is forgotten: its mode is not RUN, and it has no error.
void Station::show_flags() {
  bool all_well = !parameter_.blocks.empty(), all_communicate = true;
  for (unsigned k = 0; k < parameter_.blocks.size(); ++k) {
    const Heard& heard = heard_[k];
    const bool well = heard.run && !heard.error;
    all_well = all_well && well;
    all_communicate = all_communicate && heard.communicates;
    show(Flag::trx, heard.at.has_value(), k);
    show(Flag::mod, heard.run, k);
    show(Flag::err, heard.error, k);
    show(Flag::state, well, k);
    show(Flag::setblock, true, k);
  }
  was_well_ = was_well_ || (all_well && all_communicate);
  show(Flag::rlink, was_well_);
  show(Flag::ltrbl, was_well_ && !all_well);
}

}  // namespace fieldproof::hs_link
