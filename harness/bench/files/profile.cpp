#include "harness/bench/files/profile.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <optional>

#include "harness/config_keys.hpp"
#include "reports/results/whole_file.hpp"
#include "src/base/duration.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::bench {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array<std::string_view, 12> profile_keys{
    "name",   "title",  "extends", "model",           "protocols", "decisions",
    "config", "timing", "exclude", "prepared_blocks", "notes",     "peer"};
constexpr std::array<std::string_view, 9> timing_keys{
    "response_max",    "turnaround_min",    "floor",    "max_gap",   "guard_band",
    "response_max_ms", "turnaround_min_ms", "floor_ms", "max_gap_ms"};

/// Throws `form`, what is to be written for the key.
void check(bool right, const std::string& key, std::string_view form) {
  if (!right) throw std::runtime_error(fmt::format("{} is {}", key, form));
}

std::string text_of(const std::string& key, const json& value) {
  check(value.is_string(), key, "a text: write it in quotes");
  return value;
}

std::vector<std::string> texts_of(const std::string& key, const json& value) {
  const bool right = value.is_array() &&
                     std::ranges::all_of(value, [](const json& one) { return one.is_string(); });
  check(right, key, "a list of texts: [\"...\"]");
  return value;
}

double number_of(const std::string& key, const json& value) {
  check(value.is_number(), key, "a number: write it without quotes");
  return value;
}

/// A number of milliseconds where the key ends with _ms, else text with a unit.
Duration duration_of(const std::string& key, const json& value) {
  if (key.ends_with("_ms")) {
    const double number = number_of("timing." + key, value);
    if (number < 0) throw std::runtime_error(fmt::format("timing.{} is negative", key));
    return from_ms(number);
  }
  const Result<Duration> duration =
      parse_duration(value.is_string() ? value.get<std::string>() : value.dump());
  if (!duration)
    throw std::runtime_error(fmt::format("timing.{}: {}", key, duration.error().message));
  return *duration;
}

void read_timing(const json& timing, Profile& profile) {
  check(timing.is_object(), "timing", "an object: {\"response_max\": \"500ms\"}");
  for (const auto& [key, value] : timing.items()) {
    if (std::ranges::find(timing_keys, key) == timing_keys.end())
      throw std::runtime_error(
          fmt::format("unknown key timing.{}{}", key, suggestion(key, timing_keys)));
    if (key == "guard_band") {
      profile.guard_band = number_of("timing.guard_band", value);
      if (profile.guard_band < 0 || profile.guard_band >= 1)
        throw std::runtime_error(fmt::format(
            "timing.guard_band {} is no share of a limit; write 0.1 for a tenth", value.dump()));
      continue;
    }
    const Duration duration = duration_of(key, value);
    if (key.starts_with("response_max")) profile.response_max = duration;
    if (key.starts_with("turnaround_min")) profile.turnaround_min = duration;
    if (key.starts_with("floor")) profile.floor = duration;
    if (key.starts_with("max_gap")) profile.max_gap = duration;
  }
}

void read_config(const json& config, Profile& profile) {
  check(config.is_object(), "config", "an object: {\"station\": 1}");
  for (const auto& [key, value] : config.items())
    if (!harness::is_config_key(key))
      throw std::runtime_error(
          fmt::format("unknown key config.{}{}", key, suggestion(key, harness::config_keys)));
  profile.config.update(config);
}

void read_exclude(const json& exclude, Profile& profile) {
  const auto has = [](const json& entry, const char* key) {
    return entry.is_object() && entry.contains(key) && entry[key].is_string();
  };
  const bool right = exclude.is_array() && std::ranges::all_of(exclude, [&](const json& entry) {
                       return has(entry, "id") && has(entry, "reason");
                     });
  check(right, "exclude", "a list: [{\"id\": \"GLOB\", \"reason\": \"why\"}]");
  for (const json& entry : exclude) profile.exclude.emplace_back(entry["id"], entry["reason"]);
}

vectors::Binding binding_of(const json& value) {
  if (value == "binding") return {};
  if (value == "advisory") return {.all = false, .named = {}};
  const bool ids = value.is_array() && !value.empty() &&
                   std::ranges::all_of(value, [](const json& one) { return one.is_string(); });
  check(ids, "decisions",
        "\"binding\", \"advisory\", or a list of those that the device is held to: "
        "[\"server/reply-time\"]");
  return {.all = false, .named = value};
}

json read_blocks(const json& value) {
  if (!value.is_array() ||
      !std::ranges::all_of(value, [](const json& one) { return one.is_object(); }))
    throw std::runtime_error(
        "prepared_blocks is a list of P2P blocks: objects with flag, read, save and so on");
  return value;
}

void read_key(const std::string& key, const json& value, Profile& profile) {
  if (key == "name")
    profile.name = text_of(key, value);
  else if (key == "title")
    profile.title = text_of(key, value);
  else if (key == "model")
    profile.model = text_of(key, value);
  else if (key == "protocols")
    profile.protocols = texts_of(key, value);
  else if (key == "config")
    read_config(value, profile);
  else if (key == "timing")
    read_timing(value, profile);
  else if (key == "exclude")
    read_exclude(value, profile);
  else if (key == "prepared_blocks")
    profile.prepared_blocks = read_blocks(value);
  else if (key == "notes")
    profile.notes = text_of(key, value);
  else if (key == "decisions")
    profile.decisions = binding_of(value);
  else if (key == "peer") {
    check(value.is_boolean(), key, "true or false");
    profile.peer = value;
  } else if (key != "extends") {
    throw std::runtime_error(fmt::format("unknown key '{}'{}", key, suggestion(key, profile_keys)));
  }
}

std::string known_profiles(const std::string& name, const fs::path& folder) {
  const std::vector<std::string> names = profile_names(folder);
  const std::vector<std::string_view> views(names.begin(), names.end());
  return fmt::format("{}; there are {}", suggestion(name, views), fmt::join(names, ", "));
}

bool names_a_path(const std::string& name) {
  return name.find('/') != std::string::npos || name.ends_with(".json");
}

/// What `path` extends, or nothing; what is no name is an error of its own.
Result<std::optional<std::string>> extended_by(const std::string& text, const fs::path& path) {
  const json value = json::parse(not_too_deep(text), nullptr, false);
  if (!value.is_object() || !value.contains("extends")) return std::optional<std::string>();
  if (!value["extends"].is_string())
    return fail(fmt::format("cannot read profile {}: \"extends\" is the name of another profile",
                            path.string()));
  return std::optional<std::string>(value["extends"]);
}

/// `chain`: the files that extend this one, the first first.
Result<Profile> load(const std::string& name, const fs::path& folder,
                     std::vector<std::string> chain) {
  const fs::path path = profile_path(name, folder);
  if (!fs::exists(path))
    return fail(fmt::format("no profile '{}'{}", name, known_profiles(name, folder)));
  const bool circle = std::ranges::find(chain, path.string()) != chain.end();
  chain.push_back(path.string());
  if (circle)
    return fail(fmt::format("cannot read profile {}: it extends itself: {}", path.string(),
                            fmt::join(chain, " extends ")));
  const Result<std::string> text = results::read_whole_file(path, "profile");
  if (!text) return text.error();
  const Result<std::optional<std::string>> extends = extended_by(*text, path);
  if (!extends) return extends.error();
  Profile base;
  if (*extends) {
    const bool beside =
        names_a_path(name) && fs::exists(profile_path(**extends, path.parent_path()));
    Result<Profile> extended = load(
        beside ? profile_path(**extends, path.parent_path()).string() : **extends, folder, chain);
    if (!extended && chain.size() == 1)
      return fail(fmt::format("{} (extended by {})", extended.error().message, path.string()));
    if (!extended) return extended.error();
    base = std::move(*extended);
    base.name.clear();  // a name is not inherited
  }
  return parse_profile(*text, path.string(), std::move(base));
}

}  // namespace

Result<Profile> parse_profile(const std::string& text, const std::string& file, Profile base) {
  try {
    const json value = json::parse(not_too_deep(text));
    if (!value.is_object()) return fail(fmt::format("{}: a profile is a JSON object", file));
    for (const auto& [key, entry] : value.items()) read_key(key, entry, base);
  } catch (const std::exception& error) {
    return fail(fmt::format("cannot read profile {}: {}", file, json_trouble(error)));
  }
  if (base.name.empty())
    return fail(fmt::format("cannot read profile {}: it has no \"name\"", file));
  if (base.protocols.empty())
    return fail(fmt::format("cannot read profile {}: it has no \"protocols\"", file));
  return base;
}

fs::path profile_path(const std::string& name_or_path, const fs::path& folder) {
  return names_a_path(name_or_path) ? fs::path(name_or_path) : folder / (name_or_path + ".json");
}

std::vector<std::string> profile_names(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

Result<Profile> load_profile(const std::string& name_or_path, const fs::path& folder) {
  return load(name_or_path, folder, {});
}

}  // namespace fieldproof::bench
