// `each`: many cases of one vector. A row gives texts, `${key}` stands for them.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace fieldproof::vectors {

using Row = std::vector<std::pair<std::string, std::string>>;

struct Combination {
  std::string suffix;  // of the id: "/upper/m"
  Row row;             // of all dimensions
};

/// The product of the rows of all dimensions, in the order of their names.
std::vector<Combination> combinations(const nlohmann::ordered_json& each);

/// With the row's texts for `${key}`; throws Broken where no row gives it.
std::string substitute(const std::string& text, const Row& row);
/// In every key and text of it.
nlohmann::ordered_json substitute(const nlohmann::ordered_json& value, const Row& row);

}  // namespace fieldproof::vectors
