#include "harness/vectors/fault_matrix.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "reports/results/whole_file.hpp"
#include "src/base/json_trouble.hpp"

namespace fieldproof::vectors {

using nlohmann::ordered_json;

std::string ranges(const std::set<std::size_t>& numbers) {
  std::string text;
  for (auto at = numbers.begin(); at != numbers.end();) {
    const std::size_t first = *at;
    std::size_t last = first;
    while (++at != numbers.end() && *at == last + 1) ++last;
    text += fmt::format("{}{}", text.empty() ? "" : " ", first);
    if (last > first) text += fmt::format("-{}", last);
  }
  return text;
}

namespace {

std::set<std::size_t> numbers(const std::string& text, std::size_t end) {
  std::set<std::size_t> result;
  std::istringstream in(text);
  for (std::string word; in >> word;) {
    const std::size_t dash = word.find('-');
    const std::size_t first = std::stoul(word);
    const std::size_t last = dash == std::string::npos ? first : std::stoul(word.substr(dash + 1));
    if (last >= end) throw std::out_of_range(fmt::format("there is no fault {}", last));
    for (std::size_t i = first; i <= last; ++i) result.insert(i);
  }
  return result;
}

}  // namespace

std::string to_text(const FaultMatrix& matrix) {
  std::string text = "[\n";
  for (const BrokenDevice& device : matrix) {
    text += fmt::format("{}{{\"device\": {}, \"faults\": [",
                        &device == &matrix.front() ? "" : ",\n", ordered_json(device.name).dump());
    for (const std::string& fault : device.faults)
      text += fmt::format("{}\n  {}", &fault == &device.faults.front() ? "" : ",",
                          ordered_json(fault).dump());
    text += "],\n\"cases\": {";
    bool first = true;
    for (const auto& [id, by] : device.killed) {
      text +=
          fmt::format("{}\n  {}: \"{}\"", first ? "" : ",", ordered_json(id).dump(), ranges(by));
      first = false;
    }
    text += "}}";
  }
  return text + "\n]\n";
}

Result<FaultMatrix> parse_fault_matrix(const std::string& text) try {
  FaultMatrix matrix;
  for (const ordered_json& one : ordered_json::parse(text)) {
    BrokenDevice device{one.at("device"), one.at("faults"), {}};
    for (const auto& [id, by] : one.at("cases").items())
      device.killed[id] = numbers(by.get<std::string>(), device.faults.size());
    matrix.push_back(std::move(device));
  }
  return matrix;
} catch (const std::exception& error) {
  return fail(fmt::format("cannot read faults.json: {}; write it anew with fieldproof_faults",
                          json_trouble(error)));
}

Result<FaultMatrix> load_fault_matrix(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "faults.json";
  if (!std::filesystem::exists(path)) return FaultMatrix{};
  const Result<std::string> text = results::read_whole_file(path);
  if (!text) return text.error();
  return parse_fault_matrix(*text);
}

std::set<std::string, std::less<>> killed_by_any(const FaultMatrix& matrix) {
  std::set<std::string, std::less<>> ids;
  for (const BrokenDevice& device : matrix)
    for (const auto& [id, by] : device.killed)
      if (!by.empty()) ids.insert(id);
  return ids;
}

std::vector<Alike> not_told_apart(const FaultMatrix& matrix, const std::set<std::string>& among) {
  std::vector<Alike> result;
  for (const BrokenDevice& device : matrix) {
    std::map<std::string, std::vector<std::string>> groups;
    for (const auto& [id, by] : device.killed)
      if (among.contains(id)) groups[ranges(by)].push_back(id);
    for (auto& [by, cases] : groups)
      if (by.empty() || cases.size() > 1) result.push_back({device.name, by, std::move(cases)});
  }
  return result;
}

}  // namespace fieldproof::vectors
