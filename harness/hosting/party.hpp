// An emulated device on its ways, as its host deals with it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::hosting {

/// As line::Device and net::Host say.
class Party {
 public:
  virtual ~Party() = default;
  virtual void receive(const Burst& burst) = 0;
  virtual std::optional<Time> wake_at() const = 0;
  virtual std::vector<Burst> advance(Time now) = 0;
  virtual bool listens(Transport transport, std::uint16_t port) const = 0;
};

/// The device's serial line, its network, or both together: a burst on line_link is of the line. It
/// must outlive the party. nullptr: it has not both of those that are wanted.
std::unique_ptr<Party> party_of(plc::EmulatedDevice& device, bool network, bool line);
/// The line that it has, on whatever channel.
line::Device* line_of(plc::EmulatedDevice& device);

}  // namespace fieldproof::hosting
