#include "harness/vectors/json/framings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "harness/vectors/json/broken.hpp"

namespace fieldproof::vectors {

namespace {

using json = nlohmann::ordered_json;

/// Every key of `by_framing` is one of `framings`.
void check_names(const json& by_framing, const std::vector<std::string>& framings,
                 std::string_view where) {
  for (const auto& [name, value] : by_framing.items())
    if (std::ranges::find(framings, name) == framings.end())
      throw Broken(fmt::format("{}: '{}' is none of its framings {}", where, name,
                               fmt::join(framings, ", ")));
}

/// A printed wire is that of one framing.
void take_wire(const std::string& framing, const std::vector<std::string>& framings,
               std::size_t index, json& step) {
  if (!step.contains("wire")) return;
  const json by_framing = step["wire"];
  if (!by_framing.is_object())
    throw Broken(fmt::format(
        "steps[{}].wire: say of which framing these bytes are: {{\"{}\": ...}}", index, framing));
  check_names(by_framing, framings, fmt::format("steps[{}].wire", index));
  step.erase("wire");
  if (by_framing.contains(framing)) step["wire"] = by_framing[framing];
}

/// What single steps rest on in this framing: {"1": "MANUAL/ID"}.
void take_clauses(json& result) {
  const json clauses = result["clauses"];
  result.erase("clauses");
  for (const auto& [index, clause] : clauses.items()) {
    const bool number = index.find_first_not_of("0123456789") == std::string::npos;
    if (!number || index.size() > 3 || std::stoul(index) >= result["steps"].size())
      throw Broken(fmt::format("differs: clauses: there is no step '{}'; the first is 0", index));
    result["steps"][std::stoul(index)]["clause"] = clause;
  }
}

}  // namespace

std::vector<std::string> framings_of(const json& vector) {
  if (!vector.contains("framings")) return {};
  return vector["framings"].get<std::vector<std::string>>();
}

std::string framed_id(std::string_view id, std::string_view framing) {
  return fmt::format("{}{}", framing, id.substr(std::min(id.find('/'), id.size())));
}

json framed(const json& vector, const std::string& framing) {
  const std::vector<std::string> framings = framings_of(vector);
  json result = vector;
  result.erase("framings");
  result["id"] = framed_id(vector.at("id").get_ref<const std::string&>(), framing);
  if (vector.contains("differs")) {
    const json& differs = vector["differs"];
    check_names(differs, framings, "differs");
    result.erase("differs");
    if (differs.contains(framing)) result.update(differs[framing]);
  }
  if (result.contains("clauses")) take_clauses(result);
  if (result.contains("steps"))
    for (std::size_t i = 0; i < result["steps"].size(); ++i)
      take_wire(framing, framings, i, result["steps"][i]);
  return result;
}

std::string protocol_of(std::string_view id) {
  std::string folder(id.substr(0, id.find('/')));
  std::ranges::replace(folder, '_', '-');
  return folder;
}

}  // namespace fieldproof::vectors
