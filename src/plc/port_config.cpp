#include "src/plc/port_config.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/base/spelling.hpp"

namespace fieldproof::plc {

namespace {
constexpr Duration delay_step = 10ms, longest_delay = 2550ms;
}  // namespace

Duration PortConfig::gap() const {
  return effective_gap(inter_character, inter_character_floor, line);
}

Duration effective_gap(Duration parameter, Duration floor, const line::LineSettings& line) {
  const Duration default_gap(Duration::rep{77} * 1'000'000'000 / 2 /
                             line.baud);  // 3.5 * 11 = 38.5 bits
  return std::max(parameter > Duration::zero() ? parameter : default_gap, floor);
}

std::vector<std::string_view> port_keys(std::initializer_list<std::string_view> more) {
  std::vector<std::string_view> keys{"bench_line",
                                     "delay_ms",
                                     "inter_character_floor_ms",
                                     "inter_character_ms",
                                     "line",
                                     "mode",
                                     "model",
                                     "neighbours",
                                     "protocol",
                                     "role",
                                     "rs485",
                                     "station"};
  keys.insert(keys.end(), more);
  std::ranges::sort(keys);
  return keys;
}

std::vector<std::string_view> network_keys(std::initializer_list<std::string_view> more) {
  std::vector<std::string_view> keys{
      "host_table", "inter_character_floor_ms", "mode", "model", "protocol", "role", "station"};
  keys.insert(keys.end(), more);
  std::ranges::sort(keys);
  return keys;
}

void read_port_config(ConfigReader& reader, PortConfig& to) {
  bool client = to.role == PortConfig::Role::client;
  reader.whole("station", 255, to.station);
  reader.either("role", "client", "server", client);
  reader.either("mode", "run", "stop", to.run);
  reader.line("line", to.line);
  reader.milliseconds("inter_character_ms", to.inter_character);
  reader.milliseconds("inter_character_floor_ms", to.inter_character_floor);
  reader.milliseconds("delay_ms", to.delay);
  reader.boolean("rs485", to.rs485);
  to.role = client ? PortConfig::Role::client : PortConfig::Role::server;
}

Result<const PlcModel*> known_plc_model(std::string_view name) {
  if (const PlcModel* model = find_plc_model(name)) return model;
  std::vector<std::string_view> names;
  for (const PlcModel& m : plc_models()) names.push_back(m.name);
  return fail(fmt::format("cannot make a PLC '{}': there is no such model; use one of {}{}", name,
                          plc_model_names(), suggestion(name, names)));
}

Result<const PlcModel*> check_port_config(const PortConfig& config) {
  const Result<const PlcModel*> model = known_plc_model(config.model);
  if (!model) return model;
  const auto wrong = [](const std::string& what) { return fail("cannot make a PLC: " + what); };
  if (config.station > 255) return wrong("station is not 0 to 255");
  if (config.inter_character < Duration::zero() ||
      config.inter_character_floor < Duration::zero()) {
    return wrong("the inter-character time is negative; 0 means 3.5 characters");
  }
  if (config.delay < Duration::zero() || config.delay > longest_delay ||
      config.delay % delay_step != Duration::zero()) {
    return wrong("the delay is not 0 to 2550 ms in steps of 10 ms");
  }
  return model;
}

}  // namespace fieldproof::plc
