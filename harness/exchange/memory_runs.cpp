#include "harness/exchange/memory_runs.hpp"

#include <optional>

namespace fieldproof::exchange {

using harness::Protocol;

namespace {

constexpr std::size_t word_digits = 4;

/// The only place of these words, where it can be written whole.
std::optional<Protocol::Place> only_place(const Protocol::Written& words,
                                          const Protocol& protocol) {
  std::vector<Protocol::Place> places = protocol.places(words);
  const std::size_t digits = (words.last_word - words.first_word + 1) * word_digits;
  if (places.size() != 1 || places.front().digits != digits || !places.front().declared)
    return std::nullopt;
  return std::move(places.front());
}

/// The word that this value fills; nothing where it is no single one under its usual name.
std::optional<Protocol::Written> word_of(const std::string& address, const std::string& hex,
                                         const Protocol& protocol) {
  if (hex.size() != word_digits) return std::nullopt;
  std::optional<Protocol::Written> word = protocol.named(address, word_digits);
  if (!word || word->contacts || word->first_word != word->last_word) return std::nullopt;
  const std::optional<Protocol::Place> place = only_place(*word, protocol);
  return place && place->address == address ? word : std::nullopt;
}

}  // namespace

Protocol::Setting as_one(MemoryRun run) {
  Protocol::Setting whole = run.front();
  for (const auto& [address, hex] : run.subspan(1)) whole.second += hex;
  return whole;
}

std::vector<MemoryRun> each_of(const MemoryValues& values) {
  std::vector<MemoryRun> runs;
  for (const Protocol::Setting& value : values) runs.emplace_back(&value, 1);
  return runs;
}

std::vector<MemoryRun> runs_of(const MemoryValues& values, const Protocol& protocol) {
  std::vector<MemoryRun> runs;
  std::optional<Protocol::Written> open;  // what the last run fills, where a word can follow
  for (const Protocol::Setting& value : values) {
    const std::optional<Protocol::Written> word = word_of(value.first, value.second, protocol);
    if (open && word && word->area == open->area && word->first_word == open->last_word + 1) {
      Protocol::Written both = *open;
      both.last_word = word->last_word;
      const auto place = only_place(both, protocol);
      if (place && place->address == runs.back().front().first) {
        runs.back() = {runs.back().data(), runs.back().size() + 1};
        open = both;
        continue;
      }
    }
    runs.emplace_back(&value, 1);
    open = word;
  }
  return runs;
}

}  // namespace fieldproof::exchange
