// The memory of one XINJE PLC, by area.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/base/zeroed.hpp"
#include "src/xnet/areas.hpp"

namespace fieldproof::xnet {

class Memory {
 public:
  /// All zero. `registers_d`: of D, as many as the model has (1-3, note 3); 0: those of its series.
  explicit Memory(Series series = Series::xd5, std::uint32_t registers_d = 0);

  Series series() const { return series_; }
  /// As of areas.hpp, but for what the model has no D for.
  std::optional<Component> find(std::string_view name) const;
  std::uint32_t room_from(const Component& component) const;

  /// `component` is one of this series; a bit is 0 or 1.
  std::uint16_t read(const Component& component) const;
  void write(const Component& component, unsigned value);

  /// The components 0 to size - 1 of an area, one after the other, as long as the memory lives; for
  /// who looks at them a thousand times a second.
  std::uint16_t* body(const Area& area);

  /// How often somebody wrote who is not an axis of its motion bus.
  std::uint64_t touched() const { return touched_; }
  void touch() { ++touched_; }

  /// The back door (src/plc/emulated_device.hpp): names as in areas.hpp, a word has four hex digits
  /// and a bit two ("00", "01"); more fill the components that follow.
  Status set(std::string_view name, std::string_view hex);
  Result<std::string> get(std::string_view name, std::size_t digits) const;

 private:
  std::size_t place(const Component& component) const;

  Series series_;
  std::uint32_t registers_d_;
  std::uint64_t touched_ = 0;
  struct Stored {
    Range range;
    std::size_t at = 0;  // in values_
  };
  std::vector<std::vector<Stored>> stored_;  // of each area
  Zeroed<std::uint16_t> values_;
};

}  // namespace fieldproof::xnet
