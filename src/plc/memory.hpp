// The memory of one PLC: words by area, and the contacts of timers and counters.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/base/zeroed.hpp"
#include "src/plc/address.hpp"
#include "src/plc/model.hpp"

namespace fieldproof::plc {

class PlcMemory {
 public:
  /// All zero. `model` is one of plc_models().
  explicit PlcMemory(const PlcModel& model);

  const PlcModel& model() const { return *model_; }

  /// One element; bits are 0 or 1. Rights are not looked at. `address` must fit (std::out_of_range
  /// otherwise).
  std::uint64_t read(const DeviceAddress& address) const;
  void write(const DeviceAddress& address, std::uint64_t value);

  /// Who writes says so when all that belongs together is written: `watcher`, where there is one,
  /// looks at memory then. P2P fires by the bits of memory.
  void written() const {
    if (watcher_) watcher_();
  }
  void watch(std::function<void()> watcher) { watcher_ = std::move(watcher); }

 private:
  void check(const DeviceAddress& address) const;

  const PlcModel* model_;
  std::array<std::uint32_t, 16> first_word_{};     // of each area in words_
  std::array<std::uint32_t, 16> first_contact_{};  // of each area in contacts_
  Zeroed<std::uint16_t> words_;
  Zeroed<std::uint8_t> contacts_;
  std::function<void()> watcher_;
};

/// The back door (emulated_device.hpp), which says `written`: `hex` fills as many elements as it
/// has digits for; a bit is "00" or "01".
Status set_by_name(PlcMemory& memory, std::string_view address, std::string_view hex);
/// `digits` 0: one element.
Result<std::string> get_by_name(const PlcMemory& memory, std::string_view address,
                                std::size_t digits);

}  // namespace fieldproof::plc
