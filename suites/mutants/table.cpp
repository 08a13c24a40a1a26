#include "suites/mutants/table.hpp"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace fieldproof::mutants {

using nlohmann::json;

namespace {

Result<json> read(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) return fail(fmt::format("cannot open {}", file));
  json value = json::parse(stream, nullptr, false);
  if (!value.is_array()) return fail(fmt::format("{} is no list", file));
  return value;
}

/// Of an entry what is left out fits any.
bool fits(const json& entry, const Mutant& mutant) {
  const auto is = [&](const char* key, const std::string& text) {
    return !entry.contains(key) || entry[key] == text;
  };
  return is("file", mutant.file) && is("function", mutant.function) && is("rule", mutant.rule) &&
         is("before", mutant.before) && is("after", mutant.after);
}

}  // namespace

Result<std::vector<Mutant>> load_table(const std::string& file) {
  const Result<json> rows = read(file);
  if (!rows) return rows.error();
  std::vector<Mutant> mutants;
  for (const json& row : *rows)
    mutants.push_back({row.at("id"), row.at("protocol"), row.at("file"), row.at("line"),
                       row.at("column"), row.at("function"), row.at("rule"), row.at("before"),
                       row.at("after"), row.at("once"), ""});
  return mutants;
}

Status load_equivalent(const std::string& file, std::vector<Mutant>& mutants) {
  const Result<json> entries = read(file);
  if (!entries) return entries.error();
  std::string stale;
  for (const json& entry : *entries) {
    bool found = false;
    for (Mutant& mutant : mutants) {
      if (!fits(entry, mutant)) continue;
      mutant.equivalent = entry.at("why");
      found = true;
    }
    if (!found) stale += "\n  " + entry.dump();
  }
  if (stale.empty()) return ok();
  return fail(fmt::format("{}: take out what no mutant is any more:{}", file, stale));
}

}  // namespace fieldproof::mutants
