#include "harness/vectors/json/each.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/vectors/json/broken.hpp"

namespace fieldproof::vectors {

using json = nlohmann::ordered_json;

std::vector<Combination> combinations(const json& each) {
  std::vector<Combination> result{{}};
  for (const auto& [dimension, rows] : each.items()) {
    std::vector<Combination> next;
    for (const Combination& base : result)
      for (const json& row : rows) {
        Combination combination = base;
        combination.suffix += '/' + row.at("case").get<std::string>();
        for (const auto& [key, value] : row.items())
          if (key != "case") combination.row.emplace_back(key, value.get<std::string>());
        next.push_back(std::move(combination));
      }
    result = std::move(next);
  }
  return result;
}

std::string substitute(const std::string& text, const Row& row) {
  if (text.find("${") == std::string::npos) return text;
  std::string result;
  std::size_t from = 0;
  for (std::size_t at; (at = text.find("${", from)) != std::string::npos;) {
    const std::size_t end = text.find('}', at);
    if (end == std::string::npos) throw Broken(fmt::format("'${{' without '}}' in \"{}\"", text));
    const std::string key = text.substr(at + 2, end - at - 2);
    const auto found = std::ranges::find(row, key, &Row::value_type::first);
    if (found == row.end())
      throw Broken(fmt::format("no row of `each` gives '${{{}}}' in \"{}\"", key, text));
    result.append(text, from, at - from).append(found->second);
    from = end + 1;
  }
  return result.append(text, from);
}

json substitute(const json& value, const Row& row) {
  if (value.is_string()) return substitute(value.get_ref<const std::string&>(), row);
  if (value.is_array()) {
    json result = json::array();
    for (const json& element : value) result.push_back(substitute(element, row));
    return result;
  }
  if (!value.is_object()) return value;
  json result = json::object();
  for (const auto& [key, element] : value.items())
    result[substitute(key, row)] = substitute(element, row);
  return result;
}

}  // namespace fieldproof::vectors
