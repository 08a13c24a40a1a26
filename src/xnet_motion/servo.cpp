#include "src/xnet_motion/servo.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <nlohmann/json.hpp>

#include "src/xnet/areas.hpp"

namespace fieldproof::xnet {

namespace {

using nlohmann::json;

Error wrong(unsigned axis, const std::string& what) {
  return fail(fmt::format("cannot set up the servo of axis {}: {}", axis, what));
}

/// What 2-6-2 sets for 10 axes.
std::map<std::string, int> right_parameters(unsigned axis) {
  return {{"P0-01", 10},     {"P0-03", 3},  {"P0-05", 0},    {"P7-00", static_cast<int>(axis)},
          {"P7-01", 0x2213}, {"P7-02", 2},  {"P7-03", 9},    {"P7-04", 15},
          {"P7-05", 10},     {"P7-06", 10}, {"P7-07", 3000}, {"P7-20", 1}};
}

std::optional<int> whole(const json& value) {
  if (value.is_number_integer()) return value.get<int>();
  if (!value.is_string()) return std::nullopt;
  const std::string& text = value.get_ref<const std::string&>();
  const bool hex = text.starts_with("0x");
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] =
      std::from_chars(text.data() + (hex ? 2 : 0), end, number, hex ? 16 : 10);
  return error == std::errc() && stop == end ? std::optional(number) : std::nullopt;
}

std::optional<double> number(const json& value) {
  if (value.is_number()) return value.get<double>();
  const std::optional<int> read = whole(value);
  return read ? std::optional<double>(*read) : std::nullopt;
}

Result<Switch> read_switch(unsigned axis, const std::string& name, const json& where) {
  const std::optional<Component> input = find_component(name);
  if (!input || input->area->name != "X" || input->number >= input->area->size)
    return wrong(axis, fmt::format("a switch at '{}'; inputs of the PLC are X0 to X77", name));
  const std::optional<double> from =
      where.is_array() && where.size() == 2 ? number(where[0]) : std::nullopt;
  const std::optional<double> to = from ? number(where[1]) : std::nullopt;
  if (!to || *from > *to)
    return wrong(axis, fmt::format("the switch {} at {}; write [from, to]", name, where.dump()));
  return Switch{input->number, *from, *to};
}

Status read_key(const std::string& key, const json& value, Servo& servo) {
  const auto parameter = servo.parameters.find(key);
  if (parameter != servo.parameters.end()) {
    const std::optional<int> read = whole(value);
    if (!read) return wrong(servo.axis, fmt::format("{}: {} is no number", key, value.dump()));
    parameter->second = *read;
    return ok();
  }
  if (key == "switches" && value.is_object()) {
    for (const auto& [name, where] : value.items()) {
      const Result<Switch> one = read_switch(servo.axis, name, where);
      if (!one) return one.error();
      servo.switches.push_back(*one);
    }
    return ok();
  }
  const std::array<std::pair<std::string_view, double*>, 3> numbers{
      {{"start", &servo.start}, {"z", &servo.z_phase}, {"rated", &servo.rated_torque}}};
  for (const auto& [name, to] : numbers) {
    if (key != name) continue;
    const std::optional<double> read = number(value);
    if (!read) return wrong(servo.axis, fmt::format("{}: {} is no number", key, value.dump()));
    *to = *read;
    return ok();
  }
  return wrong(servo.axis,
               fmt::format("'{}'; there are axis, start, switches, z, rated, and parameters P0-01, "
                           "P0-03, P0-05, P7-00 to P7-07, P7-20",
                           key));
}

struct Counter {
  std::string_view kind, name;
};
constexpr std::array counters{Counter{"sync", "U0-62"}, Counter{"data", "U0-64"},
                              Counter{"crc", "U0-66"}, Counter{"uart", "U0-67"}};

}  // namespace

bool BusCounters::expect(std::string_view kind, unsigned periods) {
  const auto found = std::ranges::find(counters, kind, &Counter::kind);
  if (found == counters.end()) return false;
  kind_ = static_cast<std::size_t>(found - counters.begin());
  periods_ = periods;
  return true;
}

void BusCounters::refresh(unsigned retries) {
  if (periods_ == 0) {
    in_a_row_ = 0;
    lost_ = false;
    return;
  }
  --periods_;
  ++all_;
  ++of_kind_[kind_];
  if (++in_a_row_ < retries || lost_) return;
  lost_ = true;
  ++overtimes_;
}

std::optional<unsigned> BusCounters::get(std::string_view name) const {
  if (name == "U0-61") return all_;
  if (name == "U0-68") return overtimes_;
  const auto found = std::ranges::find(counters, name, &Counter::name);
  if (found == counters.end()) return std::nullopt;
  return of_kind_[static_cast<std::size_t>(found - counters.begin())];
}

int Servo::parameter(const std::string& name) const {
  const auto found = parameters.find(name);
  return found == parameters.end() ? 0 : found->second;
}

Result<Servo> read_servo(const json& config) {
  Servo servo;
  const std::optional<int> axis =
      config.is_object() ? whole(config.value("axis", json(1))) : std::nullopt;
  if (!axis || *axis < 1 || *axis > 20)
    return fail(fmt::format("cannot set up the servo {}: its axis is 1 to 20", config.dump()));
  servo.axis = static_cast<unsigned>(*axis);
  servo.parameters = right_parameters(servo.axis);
  for (const auto& [key, value] : config.items())
    if (key != "axis")
      if (const Status read = read_key(key, value, servo); !read) return read.error();
  return servo;
}

Status check_servo(const Servo& servo, unsigned slaves, unsigned refresh_us) {
  const auto needs = [&](const std::string& name, const std::string& what) {
    return wrong(servo.axis, fmt::format("{} is {}; {}", name, servo.parameter(name), what));
  };
  const int mode = servo.parameter("P0-01");
  if (mode < 8 || mode > 10) return needs("P0-01", "set 8 (torque), 9 (speed) or 10 (position)");
  if (servo.parameter("P0-03") != 3) return needs("P0-03", "set 3 (fieldbus enable)");
  if (servo.parameter("P0-05") != 0) return needs("P0-05", "set 0 (2-5, 20006)");
  if (servo.axis > slaves)
    return needs("P7-00", fmt::format("SFD2991 has stations 1 to {}", slaves));
  if (servo.parameter("P7-00") != static_cast<int>(servo.axis))
    return needs("P7-00", "set the number of the axis");
  if (servo.parameter("P7-01") != 0x2213) return needs("P7-01", "set 0x2213 (3 Mbit/s, 8E1)");
  // 3: 2-3-2 asks for it where the torque is fed back.
  if (servo.parameter("P7-02") != 2 && servo.parameter("P7-02") != 3)
    return needs("P7-02", "set 2 (simple XNet)");
  if (servo.parameter("P7-05") != static_cast<int>(slaves))
    return needs("P7-05", fmt::format("set {}, as SFD2991 of the PLC", slaves));
  if (servo.parameter("P7-07") != static_cast<int>(refresh_us))
    return needs("P7-07", fmt::format("set {}, as SFD2990 of the PLC", refresh_us));
  return ok();
}

}  // namespace fieldproof::xnet
