#include "harness/explore/learnt.hpp"

#include <fmt/format.h>

#include <utility>

namespace fieldproof::explore {

namespace {

constexpr std::size_t most_otherwise = 1000;

}  // namespace

std::string Learnt::key_of(const Request& request, const std::string& own_sort) {
  return notation::print(request.notation) + " / " + own_sort;
}

const Reading* Learnt::find(const std::string& key) const {
  const auto found = readings_.find(key);
  return found == readings_.end() ? nullptr : &found->second;
}

void Learnt::learn(const std::string& key, const Request& request, Reading reading) {
  const bool other = reading.sort != reading.own_sort;
  if (!readings_.try_emplace(key, std::move(reading)).second) return;
  if (other && otherwise_.size() < most_otherwise) otherwise_.push_back(request);
}

std::vector<std::string> Learnt::lines() const {
  std::map<std::string, std::pair<std::uint64_t, std::string>> times;  // and the first request
  for (const auto& [key, reading] : readings_) {
    if (reading.sort == reading.own_sort) continue;
    auto& [count, first] = times[fmt::format("{}: {} here, {} on the device", reading.what,
                                             reading.own_sort, reading.sort)];
    if (++count == 1) first = key.substr(0, key.rfind(" / "));
  }
  std::vector<std::string> lines;
  for (const auto& [what, of] : times)
    lines.push_back(fmt::format("{} ({} requests, one is {:.120})", what, of.first, of.second));
  return lines;
}

}  // namespace fieldproof::explore
