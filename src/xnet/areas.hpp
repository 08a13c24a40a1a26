// The soft components of a XINJE PLC with Ethernet (XDE, XD5E, XG): names and numbers of X-NET 1-3,
// and where Modbus shows them. X and Y are numbered in octal.
//
// 1-3 prints no Modbus addresses; 3-4-2 refers to the XD/XL manual, 6-2-3. Decision: the map of
// that manual, in which an area reaches as far as the next one begins, so Modbus does not show all
// of D, M and HD. D ends at 4FFF, where the inputs of modules begin. Modules and extension boards
// (X10000, ID10000, ...) are not emulated.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fieldproof::xnet {

struct Area {
  std::string_view name;  // "HD"
  bool bits = false;
  std::uint32_t size = 0;    // components 0 to size - 1 (X-NET 1-3)
  std::uint32_t modbus = 0;  // data address of the first, among coils or registers
  std::uint32_t shown = 0;   // to Modbus: so many of them
  bool octal = false;
};

std::span<const Area> areas();

/// A component by its name.
struct Component {
  const Area* area = nullptr;
  std::uint32_t number = 0;
};
/// "D100", "HD0", "X17" (the sixteenth): letters in either case. Nothing where there is none.
std::optional<Component> find_component(std::string_view name);
/// The component at a data address of coils or registers.
std::optional<Component> component_at(bool bits, std::uint32_t modbus);

/// "X17"
std::string to_string(const Component& component);

}  // namespace fieldproof::xnet
