// One TBN bus on given time: who has the token, and what is carried while it has it. No frame is on
// any wire; a transfer is so many words (X-NET 1-1-3, 1-4). What the manual is silent about:
// DECISIONS.md xnet/token.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "src/base/trace.hpp"

namespace fieldproof::xnet {

class TokenBus {
 public:
  /// `cycle`: in which each station has the token once. `baud` in bit/s.
  TokenBus(Duration cycle, unsigned baud) : cycle_(cycle), baud_(baud) {}

  /// The station has so many words to carry; `done` is told when the last of them went, `lost` by
  /// nobody but who lets the station leave.
  struct Transfer {
    std::uint32_t words = 1;
    std::function<void(Time)> done;
    std::function<void()> lost{};
    Duration late{};  // it takes so much longer: one end of it is slow
  };

  /// From now on the station takes part, or does not. A holder that leaves takes the token with it
  /// until its turn would have ended.
  void join(unsigned station);
  /// The transfers that it takes with it.
  std::vector<Transfer> leave(unsigned station);
  bool is_there(unsigned station) const { return queues_.contains(station); }

  void queue(unsigned station, Transfer transfer, Time now);

  /// Words that the bus carries in 10 ms: 200 at 1 Mbit/s (1-4, note 3).
  Duration time_of(std::uint32_t words) const;

  std::optional<Time> wake_at() const;
  void advance(Time now);

  /// The last turns, the newest at the end; at most so many are kept.
  static constexpr std::size_t kept_turns = 1000;
  const std::deque<TokenTurn>& turns() const { return turns_; }
  /// Of them, as far as `now`, so many as a picture can show: from about the first that carried on,
  /// else the last. None where one station has the token all the time.
  std::vector<TokenTurn> shown_turns(Time now) const;
  Duration cycle() const { return cycle_; }

 private:
  void begin_turn(Time now);
  void carry(Time now);

  struct Waiting {
    Transfer transfer;
    Duration left{};
  };
  Duration cycle_;
  unsigned baud_;
  std::map<unsigned, std::deque<Waiting>> queues_;  // by station
  std::deque<TokenTurn> turns_;
  unsigned holder_ = 0;
  Time turn_ends_{};
  std::optional<Time> carried_until_;  // of the transfer under way
  bool begun_ = false;
};

}  // namespace fieldproof::xnet
