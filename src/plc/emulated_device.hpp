// A device with a back door: what an emulator offers beyond the wire, so that a case can start from
// a known state and look at the result without asking the device about itself.
#pragma once

#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/line/device.hpp"

namespace fieldproof::plc {

class EmulatedDevice : public line::Device {
 public:
  /// Sets memory at a device address ("%MW100", "%MX0010A") to hex digits, most significant first.
  /// More digits than the type has fill the following elements. Rights do not bind the back door.
  /// Errors name the address.
  virtual Status set(std::string_view address, std::string_view hex) = 0;

  /// The value at a device address as `digits` hex digits (0: the size of the type; more: following
  /// elements).
  /// "@status", "@errors" and "@services" are the counters of the status by service (Cnet
  /// EN 11.1.4), in hex.
  virtual Result<std::string> get(std::string_view address, std::size_t digits) const = 0;

  /// "run", "stop" or "power_cycle".
  virtual Status act(std::string_view action) = 0;
};

}  // namespace fieldproof::plc
