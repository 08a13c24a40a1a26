#include "harness/explore/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace fieldproof::explore {

using harness::Protocol;

void Limits::Scale::note(std::uint32_t number, const std::string& sort) {
  if (sort == "answered") {
    first = std::min(first.value_or(number), number);
    last = std::max(last.value_or(number), number);
  } else if (sort != "silence" && sort != "closed") {
    const auto [lowest, is_new] = lowest_refused.try_emplace(sort, number);
    // One below what is granted was refused for something else.
    if (number < lowest->second || lowest->second <= last.value_or(0)) lowest->second = number;
  }
}

std::optional<std::uint32_t> Limits::Scale::middle() const {
  if (!last) return std::nullopt;
  std::optional<std::uint32_t> refused;
  for (const auto& [sort, lowest] : lowest_refused)
    if (lowest > *last) refused = std::min(refused.value_or(lowest), lowest);
  if (!refused || *refused - *last < 2) return std::nullopt;
  return *last + (*refused - *last) / 2;
}

void Limits::note(const std::string& service, const std::optional<Count>& count,
                  const std::vector<Protocol::Written>& words, const std::string& sort) {
  ++answers_[service][sort];
  if (count) {
    Scale& scale = counts_[service];
    scale.name = count->field.name;
    scale.note(count->value, sort);
  }
  // Of several places nobody knows which was refused.
  for (const Protocol::Written& one : words)
    if (!one.unknown() && !one.contacts && (sort == "answered" || words.size() == 1))
      areas_[one.area].note(sort == "answered" ? one.last_word : one.first_word, sort);
}

std::optional<std::uint32_t> Limits::count_between(const std::string& service) const {
  const auto found = counts_.find(service);
  return found == counts_.end() ? std::nullopt : found->second.middle();
}

std::string Limits::Scale::refused(const std::function<std::string(std::uint32_t)>& spell) const {
  std::optional<std::pair<std::uint32_t, std::string>> nearest;
  for (const auto& [sort, lowest] : lowest_refused)
    if (lowest > last.value_or(0) && (!nearest || lowest < nearest->first))
      nearest = {lowest, sort};
  return nearest ? fmt::format(", {} refused with {}", spell(nearest->first), nearest->second) : "";
}

std::vector<std::string> Limits::services() const {
  std::vector<std::string> lines;
  for (const auto& [service, sorts] : answers_) {
    std::string all;
    for (const auto& [sort, times] : sorts)
      all += fmt::format("{}{} {}", all.empty() ? "" : ", ", sort, times);
    lines.push_back(fmt::format("{}: {}", service, all));
  }
  return lines;
}

std::vector<std::string> Limits::limits(const Protocol& spelling) const {
  std::vector<std::string> lines;
  for (const auto& [service, scale] : counts_) {
    if (!scale.last) continue;
    lines.push_back(
        fmt::format("{}, {}: {} to {} accepted{}", service, scale.name, *scale.first, *scale.last,
                    scale.refused([](std::uint32_t number) { return std::to_string(number); })));
  }
  for (const auto& [area, scale] : areas_) {
    if (!scale.last) continue;
    const auto word = [&, &name = area](std::uint32_t number) {
      return spelling.spell(name, number);
    };
    lines.push_back(fmt::format("area {}: {} to {} good{}", area, word(*scale.first),
                                word(*scale.last), scale.refused(word)));
  }
  return lines;
}

}  // namespace fieldproof::explore
