// A device with a back door: what an emulator offers beyond the wire, so that a case can start from
// a known state and look at the result without asking the device about itself.
#pragma once

#include <string>
#include <string_view>

#include "src/base/result.hpp"
#include "src/base/trace.hpp"
#include "src/line/device.hpp"
#include "src/net/host.hpp"
#include "src/plc/bus_end.hpp"

namespace fieldproof::plc {

class EmulatedDevice {
 public:
  virtual ~EmulatedDevice() = default;

  /// What it has on a serial channel, and on its network; nullptr: nothing. All belong to the
  /// device. Channel 0 is the one that its configuration leads to, else 1.
  virtual line::Device* line([[maybe_unused]] unsigned channel = 0) { return nullptr; }
  virtual net::Host* network() { return nullptr; }
  /// Where a device in another process may join it.
  virtual BusEnd* bus_end() { return nullptr; }

  /// Sets memory at a device address ("%MW100", "%MX0010A") to hex digits, most significant first.
  /// More digits than the type has fill the following elements. Rights do not bind the back door.
  /// Errors name the address.
  virtual Status set(std::string_view address, std::string_view hex) = 0;

  /// The value at a device address as `digits` hex digits (0: the size of the type; more: following
  /// elements).
  /// "@status", "@errors" and "@services" are the counters of the status by service (Cnet
  /// EN 11.1.4), in hex; further names: vectors/README.md.
  virtual Result<std::string> get(std::string_view address, std::size_t digits) const = 0;

  /// "run", "stop" or "power_cycle".
  virtual Status act(std::string_view action) = 0;

  /// What moved since it was made, and who had the token; of devices on a wire nothing.
  virtual Trace trace() const { return {}; }
};

/// A device that is one serial line and nothing else.
class SerialDevice : public EmulatedDevice, public line::Device {
 public:
  line::Device* line(unsigned channel = 0) override { return channel <= 1 ? this : nullptr; }
};

}  // namespace fieldproof::plc
