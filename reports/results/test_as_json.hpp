// How a value stands in a file of results, for tests.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "reports/results/result_json.hpp"

namespace fieldproof::results::test {

inline nlohmann::json as_json(const auto& value) {
  std::string text;
  append_json(text, value);
  return nlohmann::json::parse(text);
}

}  // namespace fieldproof::results::test
