// As much of JSON Schema (draft 7) as our own schemas use, for tests. A keyword that it does not
// know is an error, so that no schema is checked in part.
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace fieldproof::results::test {

using nlohmann::json;

class JsonSchema {
 public:
  explicit JsonSchema(const json& schema) : root_(schema) {}

  /// What is wrong with `document`, one line each; empty: nothing.
  std::vector<std::string> problems(const json& document) const {
    std::vector<std::string> found;
    check(root_, document, "", found);
    return found;
  }

 private:
  using Found = std::vector<std::string>;

  bool holds(const json& schema, const json& value) const {
    Found found;
    check(schema, value, "", found);
    return found.empty();
  }

  void check(const json& schema, const json& value, const std::string& path, Found& found) const {
    for (const auto& [keyword, rule] : schema.items()) {
      const auto require = [&](bool right) {
        if (!right) found.push_back(path + ": " + keyword + " " + rule.dump().substr(0, 80));
      };
      if (keyword == "$ref")
        check(root_.at(json::json_pointer(rule.get<std::string>().substr(1))), value, path, found);
      else if (keyword == "type")
        require(has_type(rule, value));
      else if (keyword == "enum")
        require(std::ranges::count(rule, value) > 0);
      else if (keyword == "const")
        require(value == rule);
      else if (keyword == "minimum")
        require(!value.is_number() || value >= rule);
      else if (keyword == "maximum")
        require(!value.is_number() || value <= rule);
      else if (keyword == "minLength")
        require(!value.is_string() || value.get<std::string>().size() >= rule);
      else if (keyword == "maxLength")
        require(!value.is_string() || value.get<std::string>().size() <= rule);
      else if (keyword == "pattern")
        require(!value.is_string() || std::regex_search(value.get<std::string>(), regex(rule)));
      else if (keyword == "minItems")
        require(!value.is_array() || value.size() >= rule);
      else if (keyword == "maxItems")
        require(!value.is_array() || value.size() <= rule);
      else if (keyword == "minProperties")
        require(!value.is_object() || value.size() >= rule);
      else if (keyword == "required")
        require(!value.is_object() || std::ranges::all_of(rule, [&](const json& key) {
          return value.contains(key.get<std::string>());
        }));
      else if (keyword == "oneOf")
        require(std::ranges::count_if(rule, [&](const json& s) { return holds(s, value); }) == 1);
      else if (keyword == "anyOf")
        require(std::ranges::any_of(rule, [&](const json& s) { return holds(s, value); }));
      else
        check_parts(schema, keyword, value, path, found);
    }
  }

  /// Keywords with schemas of what is inside.
  void check_parts(const json& schema, const std::string& keyword, const json& value,
                   const std::string& path, Found& found) const {
    static const std::set<std::string> silent{"$schema",     "title", "description",
                                              "definitions", "then",  "else"};
    const json& rule = schema[keyword];
    if (keyword == "items") {
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i)
        check(rule, value[i], path + "[" + std::to_string(i) + "]", found);
    } else if (keyword == "properties") {
      for (const auto& [key, part] : rule.items())
        if (value.is_object() && value.contains(key))
          check(part, value[key], path + "." + key, found);
    } else if (keyword == "additionalProperties") {
      static const json nothing = json::object();
      const json& members = value.is_object() ? value : nothing;
      for (const auto& [key, part] : members.items()) {
        if (schema.contains("properties") && schema["properties"].contains(key)) continue;
        if (rule == false)
          found.push_back(path + ": unknown key " + key);
        else if (rule.is_object())
          check(rule, part, path + "." + key, found);
      }
    } else if (keyword == "allOf") {
      for (const json& part : rule) check(part, value, path, found);
    } else if (keyword == "if") {
      const char* branch = holds(rule, value) ? "then" : "else";
      if (schema.contains(branch)) check(schema[branch], value, path, found);
    } else if (!silent.contains(keyword)) {
      throw std::runtime_error("unknown keyword " + keyword);
    }
  }

  static bool has_type(const json& rule, const json& value) {
    if (rule.is_array())
      return std::ranges::any_of(rule, [&](const json& one) { return has_type(one, value); });
    if (rule == "integer") return value.is_number_integer();
    if (rule == "number") return value.is_number();
    return rule == value.type_name();
  }

  static std::regex regex(const json& pattern) {
    return std::regex(pattern.get<std::string>(), std::regex::ECMAScript);
  }

  json root_;
};

}  // namespace fieldproof::results::test
