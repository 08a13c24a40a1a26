#include "harness/bench/files/waivers.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>

#include "harness/vectors/loader.hpp"
#include "reports/results/whole_file.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::bench {

using results::Verdict;

namespace {

using nlohmann::json;

template <std::size_t n>
void refuse_unknown_keys(const json& object, const std::array<std::string_view, n>& keys) {
  for (const auto& [key, entry] : object.items())
    if (std::ranges::find(keys, key) == keys.end())
      throw std::runtime_error(fmt::format("unknown key '{}'{}", key, suggestion(key, keys)));
}

/// A day that exists, as 2027-01-31.
bool is_date(const std::string& text) {
  int year = 0;
  unsigned month = 0, day = 0;
  const auto number = [&](std::size_t from, std::size_t size, auto& value) {
    const auto [end, error] = std::from_chars(text.data() + from, text.data() + from + size, value);
    return error == std::errc() && end == text.data() + from + size;
  };
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return false;
  if (!number(0, 4, year) || !number(5, 2, month) || !number(8, 2, day)) return false;
  return std::chrono::year_month_day(std::chrono::year(year), std::chrono::month(month),
                                     std::chrono::day(day))
      .ok();
}

std::string required(const json& object, const char* key, const char* what) {
  const auto found = object.find(key);
  if (found == object.end())
    throw std::runtime_error(fmt::format("'{}' is missing: {}", key, what));
  if (!found->is_string())
    throw std::runtime_error(fmt::format("'{}' is not a text: {}", key, what));
  const auto value = found->get<std::string>();
  if (value.find_first_not_of(' ') == std::string::npos)
    throw std::runtime_error(fmt::format("'{}' is empty: {}", key, what));
  return value;
}

std::string version(const json& range, const char* key) {
  if (range.contains(key) && !range[key].is_string())
    throw std::runtime_error(fmt::format("firmware.{} is not a text; write \"1.20\"", key));
  std::string value = range.value(key, "");
  if (range.contains(key) &&
      std::ranges::none_of(value, [](char c) { return c >= '0' && c <= '9'; }))
    throw std::runtime_error(fmt::format(
        "firmware.{} '{}' has no number; write it as the device's label does, 1.20", key, value));
  return value;
}

Waiver read_waiver(const json& value) {
  constexpr std::array<std::string_view, 6> keys{"id",   "reason",  "owner",
                                                 "text", "expires", "firmware"};
  constexpr std::array<std::string_view, 2> range_keys{"from", "to"};
  if (!value.is_object()) throw std::runtime_error("it is not an object {\"id\": ...}");
  refuse_unknown_keys(value, keys);
  Waiver waiver;
  waiver.id = required(value, "id", "a case, or a glob");
  waiver.reason = required(value, "reason", "why the failure is accepted");
  waiver.owner = required(value, "owner", "who answers for it");
  waiver.text = required(value, "text",
                         "part of the failure's message, so that another failure is not hidden");
  waiver.expires = required(value, "expires", "the last day on which it holds, 2027-01-31");
  if (!is_date(waiver.expires))
    throw std::runtime_error(
        fmt::format("expires '{}' is no date; write 2027-01-31", waiver.expires));
  if (value.contains("firmware")) {
    const json& range = value["firmware"];
    if (!range.is_object())
      throw std::runtime_error(
          "'firmware' is a range: {\"from\": \"1.20\", \"to\": \"1.39\"}, or one of the two");
    refuse_unknown_keys(range, range_keys);
    waiver.firmware_from = version(range, "from");
    waiver.firmware_to = version(range, "to");
  }
  return waiver;
}

bool is_glob(const Waiver& waiver) {
  return waiver.id.find_first_of("*?:") != std::string::npos || waiver.id.starts_with('-');
}

std::string firmware_range(const Waiver& waiver) {
  if (waiver.firmware_to.empty()) return waiver.firmware_from + " and later";
  if (waiver.firmware_from.empty()) return "up to " + waiver.firmware_to;
  return waiver.firmware_from + " to " + waiver.firmware_to;
}

std::string by_whom(const Waiver& waiver) {
  return fmt::format("{} ({})", waiver.reason, waiver.owner);
}

}  // namespace

Result<std::vector<Waiver>> parse_waivers(const std::string& text, const std::string& file) {
  std::vector<Waiver> waivers;
  std::string place;
  try {
    const json entries = json::parse(not_too_deep(text));
    if (!entries.is_array())
      return fail(
          fmt::format("cannot read waivers {}: it is not an array; write [{{\"id\": ...}}]", file));
    for (const json& value : entries) {
      place = fmt::format("entry {}: ", waivers.size());
      Waiver waiver = read_waiver(value);
      const auto twin = std::ranges::find_if(waivers, [&](const Waiver& one) {
        return one.id == waiver.id && one.firmware_from == waiver.firmware_from &&
               one.firmware_to == waiver.firmware_to;
      });
      if (twin != waivers.end())
        throw std::runtime_error(fmt::format("'{}' is waived twice; remove one", waiver.id));
      waivers.push_back(std::move(waiver));
    }
  } catch (const std::exception& error) {
    return fail(fmt::format("cannot read waivers {}: {}{}", file, place, json_trouble(error)));
  }
  return waivers;
}

Result<std::vector<Waiver>> load_waivers(const std::string& path) {
  if (path.empty()) return std::vector<Waiver>{};
  const Result<std::string> text = results::read_whole_file(path, "waivers");
  return text ? parse_waivers(*text, path) : text.error();
}

std::vector<std::string> unknown_targets(const std::vector<Waiver>& waivers,
                                         const std::vector<std::string>& ids) {
  std::vector<std::string> result;
  for (const Waiver& waiver : waivers) {
    if (std::ranges::any_of(
            ids, [&](const std::string& id) { return vectors::matches_filter(id, waiver.id); }))
      continue;
    const std::vector<std::string_view> candidates(ids.begin(), ids.end());
    result.push_back(fmt::format("no case '{}'{}", waiver.id, suggestion(waiver.id, candidates)));
  }
  return result;
}

int compare_versions(std::string_view a, std::string_view b) {
  const auto next_number = [](std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_of("0123456789"), text.size()));
    unsigned long long number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return number;
  };
  while (!a.empty() || !b.empty()) {
    const auto left = next_number(a), right = next_number(b);
    if (left != right) return left < right ? -1 : 1;
  }
  return 0;
}

Waivers::Firmware Waivers::firmware_of(const Waiver& waiver) const {
  if (waiver.firmware_from.empty() && waiver.firmware_to.empty()) return Firmware::covered;
  if (firmware_.find_first_of("0123456789") == std::string::npos) return Firmware::unknown;
  const bool below =
      !waiver.firmware_from.empty() && compare_versions(firmware_, waiver.firmware_from) < 0;
  const bool above =
      !waiver.firmware_to.empty() && compare_versions(firmware_, waiver.firmware_to) > 0;
  return below || above ? Firmware::other : Firmware::covered;
}

/// The waiver of a case: one for this firmware before others, one that names the case before a
/// glob.
const Waiver* Waivers::find(const std::string& id) const {
  const Waiver* best = nullptr;
  const auto rank = [&](const Waiver& one) {
    return std::pair(firmware_of(one) != Firmware::covered, is_glob(one));
  };
  for (const Waiver& one : waivers_)
    if (vectors::matches_filter(id, one.id) && (!best || rank(one) < rank(*best))) best = &one;
  return best;
}

void Waivers::apply(results::CaseResult& result) {
  const Waiver* waiver = find(result.id);
  if (!waiver) return;
  const bool judged = results::is_judged(result.verdict);
  Came& came = came_[result.id];
  came = std::max(came, result.verdict == Verdict::fail   ? Came::failed
                        : result.verdict == Verdict::skip ? Came::skipped
                        : judged                          ? Came::held
                                                          : Came::unjudged);
  if (!judged) return;
  const Firmware firmware = firmware_of(*waiver);
  const auto note = [&](std::string text) { result.notes.push_back(std::move(text)); };
  if (result.verdict != Verdict::fail) {
    if (is_glob(*waiver) || firmware != Firmware::covered)
      return;  // a glob may cover cases that pass: see superfluous()
    result.message =
        fmt::format("is {}, but waived as failing until {}: {}; remove the waiver",
                    results::to_string(result.verdict), waiver->expires, by_whom(*waiver));
    result.verdict = Verdict::xpass;
  } else if (firmware == Firmware::unknown) {
    note(
        fmt::format("not waived: the waiver is for firmware {}, and the device's is not known; "
                    "enter it in the bench file",
                    firmware_range(*waiver)));
  } else if (firmware == Firmware::other) {
    note(
        fmt::format("not waived: the waiver is for firmware {}, the device has {}; correct the "
                    "fault or the waiver",
                    firmware_range(*waiver), firmware_));
  } else if (today_ > waiver->expires) {
    note(
        fmt::format("not waived: the waiver expired on {}: {}; correct the fault, or have its "
                    "owner set a new date",
                    waiver->expires, by_whom(*waiver)));
  } else if (result.message.find(waiver->text) == std::string::npos) {
    note(
        fmt::format("not waived: the waiver is for another failure, '{}'; correct the fault, or "
                    "the waiver's text",
                    waiver->text));
  } else {
    result.verdict = Verdict::xfail;
    note(fmt::format("waived until {}: {}", waiver->expires, by_whom(*waiver)));
  }
}

std::vector<results::CaseResult> Waivers::superfluous(const std::vector<std::string>& ids) const {
  std::vector<results::CaseResult> results;
  for (const Waiver& waiver : waivers_) {
    if (!is_glob(waiver) || firmware_of(waiver) != Firmware::covered) continue;
    std::size_t covered = 0, judged = 0;
    const bool failed = std::ranges::any_of(ids, [&](const std::string& id) {
      if (!vectors::matches_filter(id, waiver.id) || find(id) != &waiver) return false;
      const auto found = came_.find(id);
      const Came came = found == came_.end() ? Came::unjudged : found->second;
      covered += came != Came::skipped;
      judged += came >= Came::held;
      return came == Came::failed;
    });
    // What was not judged proves nothing; some is never judged on any bench.
    const bool enough = static_cast<double>(judged) >= enough_judged * static_cast<double>(covered);
    if (failed || judged == 0 || !enough) continue;
    results::CaseResult result;
    result.id = std::string(waiver_result) + waiver.id;
    result.title = fmt::format("The waiver for {} is still needed", waiver.id);
    result.verdict = Verdict::xpass;
    result.message = fmt::format(
        "none of the {} cases that {} covers and that were judged fails any more, but they are "
        "waived until {}: {}; remove the waiver",
        judged, waiver.id, waiver.expires, by_whom(waiver));
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace fieldproof::bench
