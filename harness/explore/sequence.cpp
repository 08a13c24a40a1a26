#include "harness/explore/sequence.hpp"

#include <algorithm>

#include "harness/protocol.hpp"

namespace fieldproof::explore {

const std::string& Weights::choose(Random& random) const {
  std::size_t sum = 0;
  for (const auto& [topic, weight] : weights_) sum += weight;
  std::size_t at = random.below(sum);
  for (const auto& [topic, weight] : weights_) {
    if (at < weight) return topic;
    at -= weight;
  }
  return weights_.begin()->first;
}

void Weights::note(const std::string& topic, std::uint64_t times) {
  const auto found = weights_.find(topic);
  if (found == weights_.end()) return;
  if (times == 1)
    found->second = news;
  else if (times % 64 == 0)
    found->second = std::max(least, found->second / 2);
}

vectors::Step step_of(vectors::Step::Kind kind) {
  vectors::Step step;
  step.kind = kind;
  return step;
}

vectors::Case case_of_own_model(const harness::Protocol& protocol) {
  vectors::Case one;
  one.protocol = protocol.name();
  one.level = "must";
  one.source = {"fieldproof, DECISIONS.md", own_model_decision, own_model_sentence, {}};
  return one;
}

}  // namespace fieldproof::explore
