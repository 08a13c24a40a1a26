#include "src/xnet/areas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "src/base/letters.hpp"

namespace fieldproof::xnet {

namespace {
constexpr bool coil = true, word = false, octal = true;

constexpr std::array all_areas{
    Area{"M", coil, 75000, 0x0000, 0x5000},  Area{"X", coil, 64, 0x5000, 64, octal},
    Area{"Y", coil, 64, 0x6000, 64, octal},  Area{"S", coil, 8000, 0x7000, 8000},
    Area{"SM", coil, 5000, 0x9000, 0x1000},  Area{"T", coil, 5000, 0xA000, 0x1000},
    Area{"C", coil, 5000, 0xB000, 0x1000},   Area{"ET", coil, 40, 0xC000, 40},
    Area{"SEM", coil, 1000, 0xC080, 0x80},   Area{"HM", coil, 12000, 0xC100, 0x1800},
    Area{"HS", coil, 1000, 0xD900, 1000},    Area{"HT", coil, 2000, 0xE100, 0x400},
    Area{"HC", coil, 2000, 0xE500, 0x400},   Area{"HSC", coil, 40, 0xE900, 40},
    Area{"D", word, 70000, 0x0000, 0x5000},  Area{"QD", word, 100, 0x6000, 100},
    Area{"SD", word, 5000, 0x7000, 0x1000},  Area{"TD", word, 5000, 0x8000, 0x1000},
    Area{"CD", word, 5000, 0x9000, 0x1000},  Area{"ETD", word, 40, 0xA000, 40},
    Area{"HD", word, 25000, 0xA080, 0x1800}, Area{"HSD", word, 2000, 0xB880, 0x400},
    Area{"HTD", word, 2000, 0xBC80, 0x400},  Area{"HCD", word, 2000, 0xC080, 0x400},
    Area{"HSCD", word, 40, 0xC480, 40},      Area{"FD", word, 8192, 0xC4C0, 0x2000},
    Area{"SFD", word, 6000, 0xE4C0, 0x1000}, Area{"FS", word, 48, 0xF4C0, 48},
};
}  // namespace

std::span<const Area> areas() { return all_areas; }

std::optional<Component> find_component(std::string_view name) {
  const std::size_t letters = std::min(name.find_first_of("0123456789"), name.size());
  const std::string area_name = upper(std::string(name.substr(0, letters)));
  const auto area = std::ranges::find(all_areas, area_name, &Area::name);
  if (area == all_areas.end() || letters == name.size()) return std::nullopt;
  const std::string_view digits = name.substr(letters);
  Component component{&*area};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(),
                                            component.number, area->octal ? 8 : 10);
  const bool whole = error == std::errc{} && end == digits.data() + digits.size();
  return whole && component.number < area->size ? std::optional(component) : std::nullopt;
}

std::optional<Component> component_at(bool bits, std::uint32_t modbus) {
  for (const Area& area : all_areas)
    if (area.bits == bits && modbus >= area.modbus && modbus - area.modbus < area.shown)
      return Component{&area, modbus - area.modbus};
  return std::nullopt;
}

std::string to_string(const Component& component) {
  return component.area->octal ? fmt::format("{}{:o}", component.area->name, component.number)
                               : fmt::format("{}{}", component.area->name, component.number);
}

}  // namespace fieldproof::xnet
