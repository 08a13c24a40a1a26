#include <fmt/format.h>

#include <algorithm>

#include "harness/vectors/json/broken.hpp"
#include "harness/vectors/json/files.hpp"
#include "harness/vectors/loader.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"

namespace fieldproof::vectors {

namespace {

using json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The literal bytes of one case: {"0": "05 30 ..", "1": {"as_sent": "06 ..", "upper": "06 .."}}.
void take_wires(const json& wires, Case& one) {
  for (const auto& [index, wire] : wires.items()) {
    const std::size_t at = index.find_first_not_of("0123456789") == std::string::npos
                               ? std::stoul(index)
                               : one.steps.size();
    if (at >= one.steps.size() || one.steps[at].frames.empty())
      throw Broken(fmt::format("steps[{}] sends and expects nothing", index));
    for (Frame& frame : one.steps[at].frames) {
      if (frame.wire) continue;
      if (wire.is_string())
        frame.wire = wire.get<std::string>();
      else if (wire.contains(frame.alternative))
        frame.wire = wire.at(frame.alternative).get<std::string>();
    }
  }
}

void load_wire_file(const fs::path& path, const std::string& name, VectorSet& set) {
  const std::string text = text_of_file(path);
  const json document = json::parse(not_too_deep(text));
  for (const auto& [id, wires] : document.items()) try {
      const auto one = std::ranges::lower_bound(set.cases, id, {}, &Case::id);
      if (one == set.cases.end() || one->id != id) throw Broken("no such case");
      take_wires(wires, *one);
    } catch (const std::exception& error) {
      set.problems.push_back(fmt::format("{}: {}: {}", name, id, json_trouble(error)));
    }
}

}  // namespace

void load_wires(const fs::path& folder, VectorSet& set) {
  if (!fs::is_directory(folder / "wires")) return;
  for (const fs::path& path : json_files(folder / "wires")) {
    const std::string name = fs::relative(path, folder).generic_string();
    try {
      load_wire_file(path, name, set);
    } catch (const std::exception& error) {
      set.problems.push_back(fmt::format("{}: {}", name, json_trouble(error)));
    }
  }
}

}  // namespace fieldproof::vectors
