// The memory of one XINJE PLC, by area.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/xnet/areas.hpp"

namespace fieldproof::xnet {

class Memory {
 public:
  /// All zero.
  Memory();

  /// `component.number` is inside its area; a bit is 0 or 1.
  std::uint16_t read(const Component& component) const;
  void write(const Component& component, unsigned value);

  /// The back door (src/plc/emulated_device.hpp): names as in areas.hpp, a word has four hex digits
  /// and a bit two ("00", "01"); more fill the components that follow.
  Status set(std::string_view name, std::string_view hex);
  Result<std::string> get(std::string_view name, std::size_t digits) const;

 private:
  std::size_t place(const Component& component) const;

  std::vector<std::size_t> first_;  // of each area in values_
  std::vector<std::uint16_t> values_;
};

}  // namespace fieldproof::xnet
