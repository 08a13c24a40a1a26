#include "harness/judge/token_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <span>

namespace fieldproof::judging {

namespace {

using Turns = std::span<const TokenTurn>;

std::string broken_by_pair(const TokenTurn& one, const TokenTurn& next) {
  if (next.from < one.to)
    return fmt::format("stations {} and {} have the token at one time", one.station, next.station);
  if (next.from > one.to && !next.begins)
    return fmt::format("nobody has the token for {:g} ms behind station {}",
                       to_ms(next.from - one.to), one.station);
  return {};
}

/// As many turns, one behind the other, as there were stations all the time.
std::string broken_by_round(Turns round, Duration cycle) {
  std::set<unsigned> had;
  for (const TokenTurn& turn : round)
    if (!had.insert(turn.station).second)
      return fmt::format("station {} has the token twice before all {} have had it", turn.station,
                         round.size());
  if (const Duration took = round.back().to - round.front().from; cycle > 0ns && took > cycle)
    return fmt::format("the token takes {:g} ms to come round, the cycle is {:g} ms", to_ms(took),
                       to_ms(cycle));
  return {};
}

bool is_round(Turns turns) {
  return std::ranges::all_of(turns,
                             [&](const TokenTurn& turn) { return turn.of == turns.size(); }) &&
         std::ranges::none_of(turns.subspan(1), &TokenTurn::begins);
}

std::string broken_at(const TokenTurn& turn, std::string rule) {
  return fmt::format("at {:g} ms {}", to_ms(turn.from), rule);
}

}  // namespace

std::string broken_token_rule(const NetTrace& net) {
  const Turns turns = net.turns;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const TokenTurn& turn = turns[i];
    if (turn.busy > turn.to - turn.from)
      return broken_at(turn,
                       fmt::format("station {} sends longer than it has the token", turn.station));
    if (i > 0)
      if (std::string rule = broken_by_pair(turns[i - 1], turn); !rule.empty())
        return broken_at(turn, std::move(rule));
    if (turn.of == 0 || turn.of > turns.size() - i) continue;
    const Turns round = turns.subspan(i, turn.of);
    if (!is_round(round)) continue;
    if (std::string rule = broken_by_round(round, net.cycle); !rule.empty())
      return broken_at(turn, std::move(rule));
  }
  return {};
}

}  // namespace fieldproof::judging
