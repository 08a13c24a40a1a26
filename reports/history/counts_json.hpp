// Counts by verdict as JSON: those that occur.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/text/tally.hpp"

namespace fieldproof::history {

inline nlohmann::ordered_json counts_json(const text::Tally& tally) {
  nlohmann::ordered_json counts = nlohmann::ordered_json::object();
  for (const results::Verdict one : text::Tally::verdicts)
    if (tally.of(one) > 0) counts[std::string(results::to_string(one))] = tally.of(one);
  return counts;
}

}  // namespace fieldproof::history
