#include "suites/xgt_cnet/p2p_facts.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "src/p2p/registers.hpp"
#include "src/plc/config_reader.hpp"

namespace fieldproof::xgt_cnet_suite {

using plc::DeviceAddress;

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 7> keys{"block", "flag", "iec",     "last_block",
                                               "mk",    "p2p",  "register"};

/// A bit, a dword, or words from `first` to `last`.
struct Place {
  DeviceAddress first, last;
};

/// "L07040" is L7040: the letters, and the rest without zeros in front.
std::string without_zeros(std::string_view text) {
  const std::size_t digits = std::min(text.find_first_of("0123456789"), text.size());
  const std::size_t first = std::min(text.find_first_not_of('0', digits), text.size());
  return std::string(text.substr(0, digits)) +
         (first == text.size() ? "0" : std::string(text.substr(first)));
}

/// "N0001~0004" is N1~4, "%LW524 ~ %LW529" is %LW524~529.
std::string normal(std::string text) {
  std::erase(text, ' ');
  const std::size_t to = text.find('~');
  if (to == std::string::npos) return without_zeros(text);
  const std::string last = text.substr(std::min(text.find_first_of("0123456789", to), text.size()));
  return without_zeros(text.substr(0, to)) + '~' + without_zeros(last);
}

std::string printed(const plc::PlcModel& model, const Place& place) {
  const char area = model.areas[place.first.area].letter;
  const std::uint32_t words = place.first.type == 'D' ? 2 : 1;
  if (!model.iec) {
    if (place.first.type == 'X')
      return fmt::format("{}{}{:X}", area, place.first.index / 16, place.first.index % 16);
    const std::uint32_t first = place.first.index * words;
    return place.first == place.last ? fmt::format("{}{}", area, first)
                                     : fmt::format("{}{}~{}", area, first, place.last.index);
  }
  const std::string first = fmt::format("%{}{}{}", area, place.first.type, place.first.index);
  return place.first == place.last ? first : fmt::format("{}~{}", first, place.last.index);
}

DeviceAddress word_before(DeviceAddress address) {
  --address.index;
  return address;
}

/// The word that holds a bit or begins a dword.
DeviceAddress word_of(DeviceAddress address) {
  if (address.type == 'X') address.index /= 16;
  if (address.type == 'D') address.index *= 2;
  address.type = 'W';
  return address;
}

std::optional<Place> flag_place(const plc::PlcModel& model, std::string_view name,
                                unsigned parameter, unsigned block, unsigned last_block) {
  const p2p::P2pResultFlags flags = p2p::p2p_result_flags(model, parameter, block);
  const auto one = [](const DeviceAddress& a) { return Place{a, a}; };
  if (name == "ndr") return one(flags.ndr);
  if (name == "err") return one(flags.err);
  if (name == "status") return one(flags.status);
  if (name == "services") return one(flags.services);
  if (name == "errors") return one(flags.errors);
  if (name != "all") return std::nullopt;
  return Place{word_of(flags.ndr),
               word_of(p2p::p2p_result_flags(model, parameter, last_block).errors) + 1};
}

std::optional<Place> register_place(const plc::PlcModel& model, std::string_view name,
                                    unsigned parameter, unsigned block, unsigned last_block) {
  const p2p::P2pRegisters registers = p2p::p2p_registers(model, parameter, block);
  if (name == "station") return Place{registers.station, registers.station};
  if (name == "all")
    return Place{registers.station,
                 p2p::p2p_registers(model, parameter, last_block).save.back().size};
  for (const auto& [which, areas] : {std::pair{"read", &registers.read}, {"save", &registers.save}})
    for (std::size_t i = 0; i < areas->size(); ++i) {
      const p2p::P2pRegisters::Area& area = (*areas)[i];
      if (name == fmt::format("{} {}", which, i + 1))
        return Place{area.name, word_before(area.size)};
      if (name == fmt::format("{} {} size", which, i + 1)) return Place{area.size, area.size};
    }
  return std::nullopt;
}

}  // namespace

Status check_p2p_fact(const json& facts) {
  if (const Status known = plc::known_keys(facts, "a fact of the P2P service", keys); !known)
    return known;
  unsigned parameter = 1, block = 0;
  std::string flag, registers;
  plc::ConfigReader reader(facts, "a fact of the P2P service");
  reader.whole("p2p", p2p::p2p_parameters, parameter);
  reader.whole("block", p2p::p2p_blocks - 1, block);
  unsigned last_block = block;
  reader.whole("last_block", p2p::p2p_blocks - 1, last_block);
  reader.text("flag", flag);
  reader.text("register", registers);
  if (reader.error()) return *reader.error();
  if (parameter == 0 || flag.empty() == registers.empty() ||
      (!facts.contains("mk") && !facts.contains("iec")))
    return fail(
        "a fact of the P2P service has p2p (1 to 3), block, flag or register, and mk or iec");
  for (const auto& [key, name] : {std::pair{"mk", "xbc-h"}, {"iec", "xec-h"}}) {
    if (!facts.contains(key)) continue;
    const plc::PlcModel& model = *plc::find_plc_model(name);
    const std::optional<Place> place =
        flag.empty() ? register_place(model, registers, parameter, block, last_block)
                     : flag_place(model, flag, parameter, block, last_block);
    if (!place)
      return fail(fmt::format("the P2P service has no {} '{}'", flag.empty() ? "register" : "flag",
                              flag.empty() ? registers : flag));
    const std::string due = facts.value(key, ""), has = printed(model, *place);
    if (normal(due) != normal(has))
      return fail(fmt::format("{} of P2P {} block {}: the table has {}, the manual {}",
                              flag.empty() ? registers : flag, parameter, block, has, due));
  }
  return ok();
}

}  // namespace fieldproof::xgt_cnet_suite
