#include "src/xgt_cnet/plc_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>

#include "src/base/spelling.hpp"

namespace fieldproof {

namespace {
using nlohmann::json;

constexpr std::array<std::string_view, 14> plc_keys{"bench_line", "delay_ms", "inter_character_floor_ms", "inter_character_ms",
                                                    "line",       "mode",     "model",                    "neighbours",
                                                    "p2p",        "protocol", "role",                     "rs485",
                                                    "station",    "time_out"};
constexpr std::array<std::string_view, 5> p2p_keys{"count", "flag", "read", "save", "station"};

std::string joined(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

Status known_keys(const json& object, std::string_view what, std::span<const std::string_view> keys) {
  if (!object.is_object()) return fail(fmt::format("cannot read {}: it is not a JSON object", what));
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(keys, key) != keys.end()) continue;
    return fail(fmt::format("cannot read {}: there is no key '{}'; the keys are {}{}", what, key, joined(keys),
                            suggestion(key, keys)));
  }
  return ok();
}

/// Values out of one object. The first that is wrong stays in `error`; later calls change nothing.
class Reader {
 public:
  Reader(const json& object, std::string what) : object_(object), what_(std::move(what)) {}

  std::optional<Error> error() const { return error_; }

  void number(const char* key, double least, double most, const std::function<void(double)>& take) {
    const json* value = find(key);
    if (!value) return;
    const std::optional<double> n = value->is_number() ? std::optional(value->get<double>()) : number_in(text_of(*value));
    if (!n || *n < least || *n > most) return wrong(key, *value, fmt::format("a number from {} to {}", least, most));
    take(*n);
  }

  void whole(const char* key, unsigned most, unsigned& to) {
    number(key, 0, most, [&](double n) {
      if (n != std::floor(n)) wrong(key, object_[key], "a whole number");
      else to = static_cast<unsigned>(n);
    });
  }

  void milliseconds(const char* key, Duration& to) {
    constexpr double longest = 60'000;
    number(key, 0, longest, [&](double n) { to = Duration(std::llround(n * 1e6)); });
  }

  void boolean(const char* key, bool& to) {
    const json* value = find(key);
    if (!value) return;
    const std::string text = value->is_string() ? value->get<std::string>() : value->dump();
    if (text == "true" || text == "1") to = true;
    else if (text == "false" || text == "0") to = false;
    else wrong(key, *value, "true or false");
  }

  void text(const char* key, std::string& to) {
    const json* value = find(key);
    if (!value) return;
    if (value->is_string()) to = value->get<std::string>();
    else wrong(key, *value, "a text");
  }

  void wrong(const std::string& key, const json& value, const std::string& expected) {
    if (error_) return;
    const std::string given = value.dump(-1, ' ', true, json::error_handler_t::replace);
    error_ = fail(fmt::format("cannot read {}: {} is {}, which is not {}", what_, key, given, expected));
  }

 private:
  const json* find(const char* key) const {
    const auto found = object_.find(key);
    return error_ || found == object_.end() ? nullptr : &*found;
  }
  static std::string text_of(const json& value) { return value.is_string() ? value.get<std::string>() : std::string(); }
  static std::optional<double> number_in(const std::string& text) {
    double n = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(n)) return std::nullopt;
    return n;
  }

  const json& object_;
  std::string what_;
  std::optional<Error> error_;
};

Result<P2pConfig> parse_p2p(const json& object, std::size_t number) {
  const std::string what = fmt::format("p2p block {}", number);
  if (const Status status = known_keys(object, what, p2p_keys); !status) return status.error();
  for (const char* key : {"flag", "read", "save", "station"}) {
    if (object.contains(key)) continue;
    return fail(fmt::format("cannot read {}: there is no {}; give flag, read, save and station", what, key));
  }
  P2pConfig block;
  Reader reader(object, what);
  reader.text("flag", block.flag);
  reader.text("read", block.read);
  reader.text("save", block.save);
  reader.whole("station", 255, block.station);
  reader.whole("count", 120, block.count);
  if (reader.error()) return *reader.error();
  return block;
}

Status parse_p2p_blocks(const json& value, std::vector<P2pConfig>& to) {
  if (!value.is_array()) return fail("cannot read the PLC's configuration: p2p is not an array of blocks");
  for (const json& object : value) {
    Result<P2pConfig> block = parse_p2p(object, to.size());
    if (!block) return block.error();
    to.push_back(std::move(*block));
  }
  return ok();
}

Result<bool> either(std::string_view key, const std::string& value, std::string_view yes, std::string_view no) {
  if (value == yes || value == no) return value == yes;
  return fail(fmt::format("cannot read the PLC's configuration: {} is '{}', which is not {} or {}", key, value, yes, no));
}
}  // namespace

Result<PlcConfig> parse_plc_config(std::string_view model, const json& config) {
  if (const Status status = known_keys(config, "the PLC's configuration", plc_keys); !status) return status.error();
  PlcConfig plc;
  plc.model = model;
  std::string role = "server", mode = "run", line = to_string(plc.line);
  Reader reader(config, "the PLC's configuration");
  reader.whole("station", 255, plc.station);
  reader.text("role", role);
  reader.text("mode", mode);
  reader.text("line", line);
  reader.milliseconds("inter_character_ms", plc.inter_character);
  reader.milliseconds("inter_character_floor_ms", plc.inter_character_floor);
  reader.milliseconds("delay_ms", plc.delay);
  reader.boolean("rs485", plc.rs485);
  reader.whole("time_out", 50, plc.time_out);
  if (reader.error()) return *reader.error();

  const Result<bool> client = either("role", role, "client", "server");
  if (!client) return client.error();
  plc.role = *client ? PlcConfig::Role::client : PlcConfig::Role::server;
  const Result<bool> run = either("mode", mode, "run", "stop");
  if (!run) return run.error();
  plc.run = *run;
  const Result<LineSettings> settings = parse_line_settings(line);
  if (!settings) return settings.error();
  plc.line = *settings;
  if (const auto p2p = config.find("p2p"); p2p != config.end()) {
    if (const Status status = parse_p2p_blocks(*p2p, plc.p2p); !status) return status.error();
  }
  return plc;
}

}  // namespace fieldproof
