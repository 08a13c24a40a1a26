// The soft components ("objects") of a XINJE PLC: names, type codes and addresses of X-NET 1-3, and
// where Modbus shows them. X and Y are numbered in octal.
//
// 1-3 prints no Modbus addresses; 3-4-2 refers to the XD/XL manual, 6-2-3. Decision: the map of
// that manual, in which an area reaches as far as the next one begins, so Modbus does not show all
// of D, M and HD. D ends at 4FFF, where the inputs of modules begin. Of X, Y, ID and QD, Modbus
// shows the body of the PLC.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::xnet {

/// Models that share a table of 1-3.
enum class Series { xd3, xd5 };  // XD2, XD3, XL3; XDM, XD5, XDC, XDE, XD5E, XG

/// Addresses that an access does not leave ("no cross-border access", 1-3): the body of the PLC, a
/// module, an ED board.
struct Range {
  std::uint32_t first = 0, count = 0;
};

struct Area {
  std::string_view name;  // "HD"
  unsigned type = 0;      // type code (1-3); 0: X-NET does not know it
  bool bits = false;
  std::uint32_t xd3 = 0, size = 0;  // components 0 to size - 1 of a XD3, of a XD5
  std::uint32_t modbus = 0;         // data address of the first, among coils or registers
  std::uint32_t shown = 0;          // to Modbus: so many of them; 0: none
  bool octal = false;
  std::uint32_t modules = 0, expansion = 0;  // address of the first of each; 0: it has none there
};

std::span<const Area> areas();
/// `name` is one of theirs.
const Area& area_named(std::string_view name);
/// In ascending order; they do not touch X-NET addresses of each other.
std::vector<Range> ranges_of(const Area& area, Series series);

/// A component by its name.
struct Component {
  const Area* area = nullptr;
  std::uint32_t number = 0;  // its X-NET address
};
/// `area` is the name of one.
Component component_in(std::string_view area, std::uint32_t number);
/// "D100", "HD0", "X17" (the sixteenth): letters in either case. Nothing where there is none.
std::optional<Component> find_component(std::string_view name, Series series = Series::xd5);
/// By type code and address (1-3).
std::optional<Component> component_of(unsigned type, std::uint32_t address,
                                      Series series = Series::xd5);
/// How many components from this one on lie in its range.
std::uint32_t room_from(const Component& component, Series series = Series::xd5);
/// The component at a data address of coils or registers.
std::optional<Component> component_at(bool bits, std::uint32_t modbus);

/// "X17"
std::string to_string(const Component& component);

}  // namespace fieldproof::xnet
