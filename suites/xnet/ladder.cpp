#include "suites/xnet/ladder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <nlohmann/json.hpp>

#include "src/base/bytes.hpp"
#include "src/xnet/areas.hpp"
#include "src/xnet/words.hpp"
#include "src/xnet_motion/motion_bus.hpp"
#include "src/xnet_network/configuration.hpp"
#include "src/xnet_network/instruction.hpp"
#include "suites/xnet/axes.hpp"
#include "suites/xnet/instruction_text.hpp"

namespace fieldproof::xnet_suite {

namespace {

using nlohmann::json;
using Setting = harness::Protocol::Setting;

bool is_of_a_program(std::string_view text) {
  return xnet::is_instruction(without_hold(text)) || !axis_of_action(text).empty();
}

bool is_register(std::string_view word) {
  const std::optional<xnet::Component> found = xnet::find_component(word);
  return found && !found->area->bits;
}

/// The low word first, as two registers have them.
std::string double_word(std::uint32_t value) {
  return hex_number(value & 0xFFFF, 4) + hex_number(value >> 16, 4);
}

/// The words of an instruction, the target of a data instruction always by type and address.
std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  xnet::Words rest(text);
  for (std::string_view word = rest.next(); !word.empty(); word = rest.next()) {
    const bool target = words.size() > 1 && words[words.size() - 2] == "station" && word != "type";
    const std::optional<xnet::Component> object =
        target ? xnet::find_component(word) : std::nullopt;
    if (!object) {
      words.emplace_back(word);
      continue;
    }
    for (const std::string& one : {std::string("type"), std::to_string(object->area->type),
                                   std::string("address"), std::to_string(object->number)})
      words.push_back(one);
  }
  return words;
}

/// What a register has for an operand: 16 bits in data instructions, but for an address; on the
/// motion bus 32 bits, or a floating number.
std::optional<std::string> operand(std::string_view instruction, std::string_view before,
                                   std::string_view word) {
  if (xnet::is_instruction(without_hold(instruction))) {
    const std::optional<std::uint32_t> value = xnet::plain_number(word);
    if (value && before == "address") return double_word(*value);
    return value && *value <= 0xFFFF ? std::optional(hex_number(*value, 4)) : std::nullopt;
  }
  if (without_hold(instruction).starts_with("MOSYN")) {
    float ratio = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, ratio);
    const bool whole = error == std::errc() && stop == end;
    return whole ? std::optional(double_word(std::bit_cast<std::uint32_t>(ratio))) : std::nullopt;
  }
  const std::optional<std::int32_t> value = xnet::constant<std::int32_t>(word);
  return value ? std::optional(double_word(static_cast<std::uint32_t>(*value))) : std::nullopt;
}

/// The operands that the program has in registers, where the rest agrees; nothing: it is another
/// instruction.
std::optional<std::vector<Setting>> operands(std::string_view program, std::string_view wanted) {
  const std::vector<std::string> has = words_of(program), wants = words_of(wanted);
  if (has.size() != wants.size()) return std::nullopt;
  std::vector<Setting> settings;
  for (std::size_t i = 0; i < has.size(); ++i) {
    const auto number = xnet::plain_number(has[i]);
    if (has[i] == wants[i] || (number && number == xnet::plain_number(wants[i]))) continue;
    const std::string_view before = i > 0 ? std::string_view(wants[i - 1]) : "";
    const std::optional<std::string> value = operand(program, before, wants[i]);
    if (!is_register(has[i]) || !value) return std::nullopt;
    settings.emplace_back(has[i], *value);
  }
  return settings;
}

/// Has it operands in registers? Nobody can tell what it would write.
bool is_open(std::string_view instruction) {
  constexpr std::array<std::string_view, 5> keys{"net", "station", "type", "address", "count"};
  if (!xnet::is_instruction(without_hold(instruction))) return false;
  const std::vector<std::string> words = words_of(instruction);
  for (std::size_t i = 0; i + 1 < words.size(); ++i)
    if (std::ranges::count(keys, words[i]) > 0 && is_register(words[i + 1])) return true;
  return false;
}

}  // namespace

/// Its program, and the stations that it is.
Status Ladder::add(const json& plc, const std::string& of) {
  const json program = plc.value("program", json::object());
  const auto number = [](const json& port, const char* key) {
    const auto found = port.find(key);
    return found != port.end() && found->is_number_unsigned() ? found->get<std::uint32_t>() : 1;
  };
  for (const json& port : plc.value("ports", json::array()))
    if (port.is_object()) stations_.push_back({of, number(port, "net"), number(port, "station")});
  if (const json ip = plc.value("ip", json()); ip.is_string())
    if (const auto own = xnet::from_ip(ip.get<std::string>()))
      stations_.push_back({of, own->net, own->station});
  if (!program.is_object())
    return fail(R"(config.program is no object; write {"M100": "REG_READ ..."})");
  for (const auto& [relay, text] : program.items()) {
    const std::optional<xnet::Component> found = xnet::find_component(relay);
    if (!found || !found->area->bits)
      return fail(fmt::format("config.program: '{}' is no relay; write M100", relay));
    if (!text.is_string() || !is_of_a_program(text.get<std::string>()))
      return fail(
          fmt::format("config.program: {} at {} is no instruction of X-NET", text.dump(), relay));
    rungs_.push_back({of, relay, text.get<std::string>()});
  }
  return ok();
}

Result<Ladder> Ladder::read(const json& config) {
  Ladder ladder;
  if (const Status own = ladder.add(config, ""); !own) return own.error();
  const json stations = config.value("stations", json::array());
  for (std::size_t i = 0; stations.is_array() && i < stations.size(); ++i) {
    if (!stations[i].is_object()) continue;
    const std::string of = i < 25 ? fmt::format("{:c}:", 'B' + i) : fmt::format("{}:", i);
    if (const Status added = ladder.add(stations[i], of); !added) return added.error();
  }
  return ladder;
}

Result<std::vector<Setting>> Ladder::set_off(std::string_view action) const {
  if (action == "run" || action == "stop" || action == "power_cycle") return std::vector<Setting>{};
  std::string_view text = action;
  const std::string of = take_plc(text);
  if (text == "release" || text.starts_with("release ")) {
    std::vector<Setting> settings;
    for (const Rung& one : rungs_)
      if (one.of == of && one.instruction.starts_with(hold))
        settings.emplace_back(of + one.relay, "00");
    return settings;
  }
  if (!is_of_a_program(text))
    return fail(fmt::format(
        "'{}' is done to the model alone; nobody can do it to this PLC from here", action));
  if (is_open(text))
    return fail(fmt::format(
        "'{}' has operands in registers: nobody can tell what it would write, and put it back",
        text));
  if (const Status fenced = names_target(text); !fenced) return fenced.error();
  for (const Rung& one : rungs_) {
    if (one.of != of) continue;
    std::optional<std::vector<Setting>> settings = operands(one.instruction, text);
    if (!settings) continue;
    for (Setting& setting : *settings) setting.first = of + setting.first;
    settings->emplace_back(of + one.relay, "00");
    settings->emplace_back(of + one.relay, "01");
    return *settings;
  }
  return fail(fmt::format(
      "needs '{0}' in the program of {1}, at a relay; name it in the profile: {2}\"program\": "
      "{{\"M100\": \"{0}\"}}",
      text, of.empty() ? "the PLC" : "PLC " + of.substr(0, 1), of.empty() ? "" : "its station's "));
}

const Ladder::Station* Ladder::station(std::uint32_t net, std::uint32_t number) const {
  const auto found = std::ranges::find_if(
      stations_, [&](const Station& one) { return one.net == net && one.station == number; });
  return found == stations_.end() ? nullptr : &*found;
}

/// What goes to a PLC that nobody declared cannot be fenced, nor put back.
Status Ladder::names_target(std::string_view instruction) const {
  const auto read = xnet::read_instruction(without_hold(instruction), xnet::Memory());
  if (!read || read->reads || station(read->net, read->station)) return ok();
  return fail(
      fmt::format("writes to station {} of net {}, which the profile does not name; declare that "
                  "PLC in config.stations, with its ports, or its ip",
                  read->station, read->net));
}

std::vector<Setting> Ladder::written_by(std::string_view action, xnet::Series series) const {
  std::string_view text = action;
  const std::string of = take_plc(text);
  const xnet::Memory nothing(series);
  const auto read = xnet::read_instruction(without_hold(text), nothing);
  if (!read || read->count == 0) return {};
  const auto place = [&](const std::string& plc, const xnet::Component& first) {
    const std::size_t count = std::min(read->count, xnet::room_from(first, series));
    return Setting{plc + to_string(first), std::string(count * (read->bits ? 2 : 4), '0')};
  };
  if (read->reads) return {place(of, read->local)};
  const auto first = xnet::component_of(read->type, read->address, series);
  const Station* const there = station(read->net, read->station);
  if (!first || !there) return {};
  return {place(there->of, *first)};
}

std::string Ladder::axis_behind(std::string_view relay) const {
  for (const Rung& one : rungs_)
    if (one.of.empty() && one.relay == relay) return axis_of_action(one.instruction);
  return {};
}

}  // namespace fieldproof::xnet_suite
