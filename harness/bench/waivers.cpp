#include "harness/bench/waivers.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "harness/vectors/loader.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof {

namespace {

constexpr std::array<std::string_view, 5> keys{"id", "reason", "owner", "expires", "text"};

bool is_date(const std::string& text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  for (std::size_t i : {0, 1, 2, 3, 5, 6, 8, 9})
    if (text[i] < '0' || text[i] > '9') return false;
  return true;
}

Waiver read_waiver(const nlohmann::json& value) {
  for (const auto& [key, entry] : value.items())
    if (std::ranges::find(keys, key) == keys.end()) throw std::runtime_error(fmt::format("unknown key '{}'{}", key, suggestion(key, keys)));
  Waiver waiver{value.at("id"), value.at("reason"), value.value("owner", ""), value.at("expires"), value.value("text", "")};
  if (!is_date(waiver.expires)) throw std::runtime_error(fmt::format("expires '{}' is no date; write 2027-01-31", waiver.expires));
  if (waiver.reason.empty()) throw std::runtime_error("the reason is empty");
  return waiver;
}

}  // namespace

Result<std::vector<Waiver>> parse_waivers(const std::string& text, const std::string& file) {
  std::vector<Waiver> waivers;
  std::size_t entry = 0;
  try {
    for (const nlohmann::json& value : nlohmann::json::parse(text)) {
      waivers.push_back(read_waiver(value));
      ++entry;
    }
  } catch (const std::exception& error) {
    return fail(fmt::format("cannot read waivers {}: entry {}: {}", file, entry, error.what()));
  }
  return waivers;
}

Result<std::vector<Waiver>> load_waivers(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return fail(fmt::format("cannot read waivers {}; is it there and readable?", path));
  return parse_waivers(std::string(std::istreambuf_iterator<char>(in), {}), path);
}

std::vector<std::string> unmatched(const std::vector<Waiver>& waivers, const std::vector<std::string>& ids) {
  std::vector<std::string> result;
  for (const Waiver& waiver : waivers)
    if (std::ranges::none_of(ids, [&](const std::string& id) { return matches_filter(id, waiver.id); })) result.push_back(waiver.id);
  return result;
}

void apply_waivers(const std::vector<Waiver>& waivers, const std::string& today, CaseResult& result) {
  const auto waiver = std::ranges::find_if(waivers, [&](const Waiver& one) { return matches_filter(result.id, one.id); });
  if (waiver == waivers.end()) return;
  const bool names_one_case = waiver->id == result.id;  // a glob may cover cases that pass
  if (result.verdict == Verdict::pass && names_one_case) {
    result.verdict = Verdict::xpass;
    result.message = fmt::format("passes, but is waived until {} ({}); remove the waiver", waiver->expires, waiver->reason);
  } else if (result.verdict == Verdict::fail && today > waiver->expires) {
    result.notes.push_back(fmt::format("the waiver expired on {} ({})", waiver->expires, waiver->reason));
  } else if (result.verdict == Verdict::fail && result.message.find(waiver->text) == std::string::npos) {
    result.notes.push_back(fmt::format("the waiver is for another failure: '{}'", waiver->text));
  } else if (result.verdict == Verdict::fail) {
    result.verdict = Verdict::xfail;
    result.notes.push_back(fmt::format("waived until {}: {}{}", waiver->expires, waiver->reason, waiver->owner.empty() ? "" : " (" + waiver->owner + ")"));
  }
}

}  // namespace fieldproof
