#include "harness/vectors/case.hpp"

#include <algorithm>
#include <cstdio>

#include "src/base/bytes.hpp"

namespace fieldproof::vectors {

std::optional<int> config_station(const nlohmann::json& config, int fallback) {
  if (!config.contains("station")) return fallback;
  const nlohmann::json& value = config["station"];
  int station = -1;
  if (value.is_number_integer()) station = value.get<int>();
  if (value.is_string()) {
    const std::string& text = value.get_ref<const std::string&>();
    if (text.empty() || text.size() > 3 ||
        text.find_first_not_of("0123456789") != std::string::npos)
      return std::nullopt;
    station = std::stoi(text);
  }
  if (station < 0 || station > 255) return std::nullopt;
  return station;
}

std::vector<std::string> alternatives_of(const Step& step) {
  std::vector<std::string> names;
  for (const Frame& frame : step.frames) names.push_back(frame.alternative);
  for (const CheckedValues& values : step.alternatives) names.push_back(values.alternative);
  return names;
}

bool is_client_case(const Case& one) { return one.config.value("role", "server") == "client"; }

bool has_role(const Case& one, const std::string& role) {
  return role.empty() || is_client_case(one) == (role == "client");
}

std::optional<std::string> expand_hex(const std::string& text) {
  std::string unit = text;
  int count = 1;
  if (std::sscanf(text.c_str(), "seq(%d)", &count) == 1 && count > 0 && count < 0x10000) {
    unit.clear();
    for (int word = 1; word <= count; ++word) unit += hex_number(static_cast<unsigned>(word), 4);
    return unit;
  }
  if (const std::size_t star = text.find('*'); star != std::string::npos) {
    if (std::sscanf(text.c_str() + star, "*%d", &count) != 1 || count < 1 || count > 100'000)
      return std::nullopt;
    unit = text.substr(0, star);
  }
  if (unit.empty() || std::ranges::any_of(unit, [](char c) { return hex_digit(c) < 0; }))
    return std::nullopt;
  std::string result;
  for (int i = 0; i < count; ++i) result += unit;
  return result;
}

}  // namespace fieldproof::vectors
