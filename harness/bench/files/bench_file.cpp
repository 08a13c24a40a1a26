#include "harness/bench/files/bench_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "harness/bench/files/profile.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/safety/fence.hpp"
#include "reports/results/whole_file.hpp"
#include "src/base/json_trouble.hpp"
#include "src/base/nesting.hpp"
#include "src/base/spelling.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::bench {

namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array<std::string_view, 12> device_keys{
    "endpoint",    "profile",  "station", "line",     "identity", "fingerprint",
    "allow_write", "operator", "notes",   "stimulus", "control",  "aux"};
constexpr std::array<std::string_view, 4> identity_keys{"maker", "model", "serial", "firmware"};

[[noreturn]] void wrong_at(const std::string& where, const std::string& why) {
  throw std::runtime_error(where + ": " + why);
}

/// `where`.`key`, with `value` an object of no other keys.
void check_object(const json& value, const std::string& where,
                  std::span<const std::string_view> keys) {
  if (!value.is_object()) wrong_at(where, "must be an object: {...}");
  for (const auto& [key, ignored] : value.items()) {
    if (std::ranges::find(keys, key) == keys.end())
      wrong_at(where, fmt::format("unknown key '{}'{}; the keys are {}", key, suggestion(key, keys),
                                  fmt::join(keys, ", ")));
  }
}

std::string read_text(const json& object, std::string_view key, const std::string& where) {
  const auto found = object.find(key);
  if (found == object.end()) return {};
  if (!found->is_string()) wrong_at(fmt::format("{}.{}", where, key), "must be a text in quotes");
  return *found;
}

std::optional<int> read_station(const json& object, const std::string& where) {
  const auto found = object.find("station");
  if (found == object.end()) return std::nullopt;
  if (!found->is_number_integer() || *found < 0 || *found > 255)
    wrong_at(where + ".station", "must be a number from 0 to 255, without quotes");
  return found->get<int>();
}

std::vector<std::string> read_allow_write(const json& object, const std::string& where,
                                          const safety::WordReader& words) {
  std::vector<std::string> ranges;
  const auto found = object.find("allow_write");
  if (found == object.end()) return ranges;
  if (!found->is_array()) wrong_at(where + ".allow_write", "must be a list: [\"M100-M199\"]");
  for (const json& range : *found) {
    if (!range.is_string())
      wrong_at(where + ".allow_write", "must be a list of texts: [\"M100-M199\"]");
    ranges.push_back(range);
    if (const Status allowed = safety::WriteFence().allow(ranges.back(), words); !allowed)
      wrong_at(where + ".allow_write", allowed.error().message);
  }
  return ranges;
}

std::map<std::string, std::string> read_fingerprint(const json& object, const std::string& where) {
  std::map<std::string, std::string> fingerprint;
  const auto found = object.find("fingerprint");
  if (found == object.end()) return fingerprint;
  if (!found->is_object())
    wrong_at(where + ".fingerprint", "must be an object: {\"NAME\": \"what is found\"}");
  for (const auto& [key, value] : found->items())
    fingerprint[key] = read_text(*found, key, where + ".fingerprint");
  return fingerprint;
}

results::Identity read_identity(const json& object, const std::string& where) {
  results::Identity identity;
  if (const auto found = object.find("identity"); found != object.end()) {
    const std::string here = where + ".identity";
    check_object(*found, here, identity_keys);
    identity.maker = read_text(*found, "maker", here);
    identity.model = read_text(*found, "model", here);
    identity.serial = read_text(*found, "serial", here);
    identity.firmware = read_text(*found, "firmware", here);
  }
  identity.operator_name = read_text(object, "operator", where);
  identity.notes = read_text(object, "notes", where);
  identity.fingerprint = read_fingerprint(object, where);
  return identity;
}

/// A path starts at the bench file's folder; a name is one of the profiles folder.
std::string resolve_profile(const std::string& profile, const fs::path& folder) {
  const bool is_path = profile_path(profile, "") == profile;
  return is_path && fs::path(profile).is_relative() ? (folder / profile).lexically_normal().string()
                                                    : profile;
}

/// What tells the endpoint its line; nothing where it sets none.
std::map<std::string, std::string> line_options(const endpoints::EndpointName& name,
                                                const line::LineSettings& line) {
  return endpoints::with_line({name.kind, name.target, {}}, line).options;
}

/// The endpoint may say station and line itself, but not otherwise than the keys.
void check_endpoint(const BenchDevice& device, const std::string& where) {
  if (device.endpoint.empty())
    wrong_at(where,
             "has no \"endpoint\"; write how it is reached: \"serial:/dev/ttyUSB0?baud=38400\"");
  const Result<endpoints::EndpointName> name = endpoints::parse_endpoint(device.endpoint);
  if (!name) wrong_at(where + ".endpoint", name.error().message);
  if (device.station && name->options.contains("station"))
    wrong_at(where + ".station", "the endpoint says a station, too; leave one of the two");
  if (device.line.empty()) return;
  const auto line = line::parse_line_settings(device.line);
  if (!line) wrong_at(where + ".line", line.error().message);
  for (const auto& [option, value] : line_options(*name, *line))
    if (name->options.contains(option))
      wrong_at(where + ".line",
               fmt::format("the endpoint says '{}', too; leave one of the two", option));
}

BenchDevice read_device(const json& object, const std::string& name, const fs::path& folder,
                        const safety::WordReader& words) {
  const std::string where = "devices." + name;
  check_object(object, where, device_keys);
  BenchDevice device;
  device.endpoint = read_text(object, "endpoint", where);
  device.profile = resolve_profile(read_text(object, "profile", where), folder);
  device.station = read_station(object, where);
  device.line = read_text(object, "line", where);
  device.stimulus = read_text(object, "stimulus", where);
  device.control = read_text(object, "control", where);
  device.aux = read_text(object, "aux", where);
  if (const auto aux = endpoints::parse_endpoint(device.aux); !aux && !device.aux.empty())
    wrong_at(where + ".aux", aux.error().message);
  device.allow_write = read_allow_write(object, where, words);
  device.identity = read_identity(object, where);
  device.identity.name = name;
  check_endpoint(device, where);
  return device;
}

/// JSON keeps the last of two equal keys in silence: a copied device would hide the one it was
/// copied from.
json parse_without_twins(const std::string& text) {
  std::vector<std::set<std::string>> keys;
  return json::parse(not_too_deep(text), [&](int, json::parse_event_t event, json& value) {
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(value).second)
      throw std::runtime_error(
          fmt::format("key '{}' stands twice in the same object; rename or remove one",
                      value.get<std::string>()));
    return true;
  });
}

}  // namespace

Result<BenchFile> parse_bench_file(const std::string& text, const std::string& path,
                                   const safety::WordReader& words) {
  BenchFile file{path, {}};
  try {
    const json root = parse_without_twins(text);
    constexpr std::array<std::string_view, 1> root_keys{"devices"};
    check_object(root, "the file", root_keys);
    if (!root.contains("devices") || !root["devices"].is_object())
      wrong_at("the file", "has no \"devices\": {...}");
    for (const auto& [name, object] : root["devices"].items())
      file.devices[name] = read_device(object, name, fs::path(path).parent_path(), words);
  } catch (const std::exception& error) {
    return fail(fmt::format("cannot read bench file {}: {}", path, json_trouble(error)));
  }
  return file;
}

Result<BenchFile> load_bench_file(const std::string& path, const safety::WordReader& words) {
  const Result<std::string> text = results::read_whole_file(path, "bench file");
  return text ? parse_bench_file(*text, path, words) : text.error();
}

Result<BenchDevice> find_device(const BenchFile& file, const std::string& name) {
  if (const auto found = file.devices.find(name); found != file.devices.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& [known, ignored] : file.devices) names.push_back(known);
  return fail(fmt::format("no device '{}' in bench file {}{}; there is {}", name, file.path,
                          suggestion(name, names),
                          names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

Result<std::vector<std::string>> find_devices(const BenchFile& file, const std::string& wanted) {
  if (file.devices.contains(wanted)) return std::vector{wanted};
  static const std::map<std::string, std::string results::Identity::*, std::less<>> fields{
      {"maker", &results::Identity::maker},
      {"model", &results::Identity::model},
      {"serial", &results::Identity::serial},
      {"firmware", &results::Identity::firmware}};
  const std::size_t equals = wanted.find('=');
  const auto field = fields.find(wanted.substr(0, equals));
  if (field == fields.end())
    return fail(
        fmt::format("cannot choose devices by '{}': write model=, maker=, serial= or "
                    "firmware= and what the bench file says there",
                    wanted));
  std::vector<std::string> found;
  std::set<std::string> there;
  for (const auto& [name, device] : file.devices) {
    const std::string& value = device.identity.*field->second;
    if (value == wanted.substr(equals + 1)) found.push_back(name);
    if (!value.empty()) there.insert(value);
  }
  if (!found.empty()) return found;
  return fail(fmt::format(
      "no device of bench file {} has {}; there is {}", file.path, wanted,
      there.empty() ? "none with a " + field->first : fmt::format("{}", fmt::join(there, ", "))));
}

std::string endpoint_of(const BenchDevice& device) {
  std::string options;
  const auto add = [&](const std::string& option) {
    options += (options.empty() ? "" : "&") + option;
  };
  const Result<endpoints::EndpointName> name = endpoints::parse_endpoint(device.endpoint);
  if (!name) return device.endpoint;
  if (device.station) add(fmt::format("station={}", *device.station));
  if (const auto line = line::parse_line_settings(device.line); line && !device.line.empty()) {
    for (const auto& [key, value] : line_options(*name, *line)) add(key + '=' + value);
  }
  if (options.empty()) return device.endpoint;
  return device.endpoint + (name->options.empty() ? "?" : "&") + options;
}

}  // namespace fieldproof::bench
