#include "src/xnet/areas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "src/base/letters.hpp"

namespace fieldproof::xnet {

namespace {
constexpr bool coil = true, reg = false, octal = true;

constexpr std::array all_areas{
    Area{"M", 3, coil, 8000, 75000, 0x0000, 0x5000},
    Area{"X", 1, coil, 64, 64, 0x5000, 64, octal, 010000, 030000},
    Area{"Y", 2, coil, 64, 64, 0x6000, 64, octal, 010000, 030000},
    Area{"S", 4, coil, 1024, 8000, 0x7000, 8000},
    Area{"SM", 13, coil, 2048, 5000, 0x9000, 0x1000},
    Area{"T", 5, coil, 576, 5000, 0xA000, 0x1000},
    Area{"C", 6, coil, 576, 5000, 0xB000, 0x1000},
    Area{"ET", 7, coil, 32, 40, 0xC000, 40},
    Area{"SEM", 18, coil, 32, 1000, 0xC080, 0x80},
    Area{"HM", 8, coil, 960, 12000, 0xC100, 0x1800},
    Area{"HS", 9, coil, 128, 1000, 0xD900, 1000},
    Area{"HT", 10, coil, 96, 2000, 0xE100, 0x400},
    Area{"HC", 11, coil, 96, 2000, 0xE500, 0x400},
    Area{"HSC", 12, coil, 32, 40, 0xE900, 40},
    Area{"D", 128, reg, 8000, 70000, 0x0000, 0x5000},
    Area{"ID", 134, reg, 100, 100, 0x5000, 0, false, 10000, 30000},
    Area{"QD", 135, reg, 100, 100, 0x6000, 100, false, 10000, 30000},
    Area{"SD", 131, reg, 2048, 5000, 0x7000, 0x1000},
    Area{"TD", 129, reg, 576, 5000, 0x8000, 0x1000},
    Area{"CD", 130, reg, 576, 5000, 0x9000, 0x1000},
    Area{"ETD", 133, reg, 32, 40, 0xA000, 40},
    Area{"HD", 136, reg, 1000, 25000, 0xA080, 0x1800},
    Area{"HSD", 140, reg, 500, 2000, 0xB880, 0x400},
    Area{"HTD", 137, reg, 96, 2000, 0xBC80, 0x400},
    Area{"HCD", 138, reg, 96, 2000, 0xC080, 0x400},
    Area{"HSCD", 139, reg, 32, 40, 0xC480, 40},
    Area{"FD", 141, reg, 6144, 8192, 0xC4C0, 0x2000},
    Area{"SFD", 142, reg, 2000, 6000, 0xE4C0, 0x1000},
    Area{"FS", 0, reg, 48, 48, 0xF4C0, 48},
};

std::uint32_t body(const Area& area, Series series) {
  return series == Series::xd3 ? area.xd3 : area.size;
}
std::uint32_t modules(Series series) { return series == Series::xd3 ? 10 : 16; }

/// Every module, and the ED board, has as many as the body.
std::optional<Range> range_around(const Area& area, std::uint32_t number, Series series) {
  const std::uint32_t each = body(area, series);
  if (number < each) return Range{0, each};
  if (area.modules == 0 || number < area.modules) return std::nullopt;
  const std::uint32_t module = (number - area.modules) / each;
  if (module < modules(series)) return Range{area.modules + module * each, each};
  if (number >= area.expansion && number - area.expansion < each)
    return Range{area.expansion, each};
  return std::nullopt;
}
}  // namespace

std::span<const Area> areas() { return all_areas; }

const Area& area_named(std::string_view name) {
  return *std::ranges::find(all_areas, name, &Area::name);
}

std::vector<Range> ranges_of(const Area& area, Series series) {
  const std::uint32_t each = body(area, series);
  std::vector<Range> ranges{{0, each}};
  if (area.modules == 0) return ranges;
  for (std::uint32_t module = 0; module < modules(series); ++module)
    ranges.push_back({area.modules + module * each, each});
  ranges.push_back({area.expansion, each});
  return ranges;
}

Component component_in(std::string_view area, std::uint32_t number) {
  return {&area_named(area), number};
}

std::optional<Component> find_component(std::string_view name, Series series) {
  const std::size_t letters = std::min(name.find_first_of("0123456789"), name.size());
  const std::string area_name = upper(std::string(name.substr(0, letters)));
  const auto area = std::ranges::find(all_areas, area_name, &Area::name);
  if (area == all_areas.end() || letters == name.size()) return std::nullopt;
  const std::string_view digits = name.substr(letters);
  Component component{&*area};
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(),
                                            component.number, area->octal ? 8 : 10);
  const bool whole = error == std::errc{} && end == digits.data() + digits.size();
  const bool there = whole && range_around(*area, component.number, series);
  return there ? std::optional(component) : std::nullopt;
}

std::optional<Component> component_of(unsigned type, std::uint32_t address, Series series) {
  const auto area = std::ranges::find(all_areas, type, &Area::type);
  if (type == 0 || area == all_areas.end() || !range_around(*area, address, series))
    return std::nullopt;
  return Component{&*area, address};
}

std::uint32_t room_from(const Component& component, Series series) {
  const std::optional<Range> range = range_around(*component.area, component.number, series);
  return range ? range->first + range->count - component.number : 0;
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
