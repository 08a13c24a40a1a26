#include "harness/bench/device_set_up.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::bench {

using nlohmann::json;
using vectors::Case;

using endpoints::plain;

namespace {

/// Not what a device under test is given: both ends of a line have them, they want a second line,
/// or the program that makes it ask is told.
constexpr std::array<std::string_view, 6> never_given{"line", "bench_line", "services",
                                                      "role", "p2p",        "time_out"};

std::string model_for(const Case& source, const harness::Protocol& protocol) {
  const std::string usual = protocol.models().front();
  const bool any =
      source.models.empty() || std::ranges::find(source.models, usual) != source.models.end();
  return any ? usual : source.models.front();
}

}  // namespace

const json& default_config() {
  static const json config{{"role", "server"},
                           {"mode", "run"},
                           {"inter_character_ms", 0},
                           {"delay_ms", 0},
                           {"rs485", false}};
  return config;
}

json declared_value(const Profile& profile, const std::string& key,
                    const harness::Protocol& protocol) {
  if (profile.config.contains(key)) return profile.config[key];
  return default_config().value(key, protocol.defaults(profile.model).value(key, json()));
}

bool means_the_same(const Profile& profile, const std::string& key, const json& one,
                    const json& other, const harness::Protocol& protocol) {
  return protocol.same_setting(profile.model, key, plain(one), plain(other));
}

json needed_set_up(const Case& source, const Profile& profile, int station,
                   const endpoints::Endpoint& endpoint, const harness::Protocol& protocol) {
  json needed = json::object();
  if (profile.model.empty() && endpoint.configures("model"))
    needed["model"] = model_for(source, protocol);
  for (const auto& [key, value] : source.config.items()) {
    if (std::ranges::find(never_given, key) != never_given.end() || !endpoint.configures(key))
      continue;
    if (key == "station") {
      const std::optional<int> own = vectors::config_station(source.config, station);
      if (own && *own != station) needed[key] = *own;
    } else if (!means_the_same(profile, key, declared_value(profile, key, protocol), value,
                               protocol)) {
      needed[key] = value;
    }
  }
  return needed;
}

json whole_config(const Profile& profile, int station, const harness::Protocol& protocol) {
  json config = default_config();
  const std::string model = profile.model.empty() ? protocol.models().front() : profile.model;
  config.update(protocol.defaults(model));
  config.update(profile.config);
  config["line"] = config.value("line", json("9600-8N1"));
  config["station"] = station;
  config["model"] = model;
  config["protocol"] = protocol.name();
  return config;
}

}  // namespace fieldproof::bench
