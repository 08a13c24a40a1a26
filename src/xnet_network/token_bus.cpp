#include "src/xnet_network/token_bus.hpp"

#include <algorithm>

namespace fieldproof::xnet {

namespace {
/// 200 words in 10 ms at 1 Mbit/s.
constexpr std::uint64_t bit_times_of_a_word = 50;

constexpr std::size_t most_shown = 200;  // turns of a picture
}  // namespace

Duration TokenBus::time_of(std::uint32_t words) const {
  return Duration(words * bit_times_of_a_word * 1'000'000'000 / baud_);
}

void TokenBus::join(unsigned station) { queues_.try_emplace(station); }

std::vector<TokenBus::Transfer> TokenBus::leave(unsigned station) {
  std::vector<Transfer> lost;
  for (Waiting& waiting : queues_[station]) lost.push_back(std::move(waiting.transfer));
  queues_.erase(station);
  if (station == holder_) carried_until_.reset();
  return lost;
}

void TokenBus::queue(unsigned station, Transfer transfer, Time now) {
  const Duration time = time_of(transfer.words) + transfer.late;
  queues_[station].push_back({std::move(transfer), time});
  if (begun_ && station == holder_ && !carried_until_ && now < turn_ends_)
    carried_until_ = now + time;
}

std::optional<Time> TokenBus::wake_at() const {
  if (queues_.empty()) return std::nullopt;
  return carried_until_ ? std::min(*carried_until_, turn_ends_) : turn_ends_;
}

void TokenBus::advance(Time now) {
  if (!begun_) {
    begun_ = true;
    turn_ends_ = now;
  }
  while (!queues_.empty()) {
    if (carried_until_ && *carried_until_ <= now && *carried_until_ <= turn_ends_)
      carry(*carried_until_);
    else if (turn_ends_ <= now)
      begin_turn(turn_ends_);
    else
      break;
  }
  if (queues_.empty()) turn_ends_ = std::max(turn_ends_, now);
}

std::vector<TokenTurn> TokenBus::shown_turns(Time now) const {
  const auto carried = [](const TokenTurn& one) { return one.busy > 0ns; };
  const auto other = [&](const TokenTurn& one) { return one.station != turns_.front().station; };
  if (std::ranges::none_of(turns_, other)) return {};
  const std::size_t room = turns_.size() - std::min(turns_.size(), most_shown);
  const auto first =
      static_cast<std::size_t>(std::ranges::find_if(turns_, carried) - turns_.begin());
  const std::size_t lead = std::min(first, queues_.size());
  const auto from = turns_.begin() + static_cast<std::ptrdiff_t>(std::min(room, first - lead));
  std::vector<TokenTurn> shown(
      from, from + static_cast<std::ptrdiff_t>(std::min(turns_.size(), most_shown)));
  shown.back().to = std::min(shown.back().to, now);
  return shown;
}

/// The next station in the order of numbers; the cycle is shared by those that are there.
void TokenBus::begin_turn(Time now) {
  if (carried_until_) {  // goes on when the token is back
    queues_[holder_].front().left = *carried_until_ - now;
    turns_.back().busy = now - turns_.back().from;
    carried_until_.reset();
  }
  auto next = queues_.upper_bound(holder_);
  if (next == queues_.end()) next = queues_.begin();
  holder_ = next->first;
  turn_ends_ = now + cycle_ / static_cast<Duration::rep>(queues_.size());
  const bool begins = turns_.empty() || turns_.back().to < now;
  turns_.push_back({holder_, now, turn_ends_, 0ms, static_cast<unsigned>(queues_.size()), begins});
  if (turns_.size() > kept_turns) turns_.pop_front();
  if (!next->second.empty()) carried_until_ = now + next->second.front().left;
}

void TokenBus::carry(Time now) {
  std::deque<Waiting>& queue = queues_[holder_];
  const Transfer done = std::move(queue.front().transfer);
  queue.pop_front();
  turns_.back().busy = now - turns_.back().from;
  carried_until_.reset();
  if (!queue.empty()) carried_until_ = now + queue.front().left;
  done.done(now);
}

}  // namespace fieldproof::xnet
