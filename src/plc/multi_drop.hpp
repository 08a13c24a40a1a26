// Several stations on one line, where there is no simulated line to put them on: behind a pty or a
// socket.
#pragma once

#include <memory>
#include <vector>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::plc {

/// All hear what arrives, and what the others send. The back door and the network lead to the
/// first.
class MultiDrop : public SerialDevice {
 public:
  /// At least one device, each with a line.
  explicit MultiDrop(std::vector<std::unique_ptr<EmulatedDevice>> devices)
      : devices_(std::move(devices)) {}

  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  Bytes advance(Time now) override;

  net::Host* network() override { return devices_.front()->network(); }

  Status set(std::string_view address, std::string_view hex) override {
    return devices_.front()->set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return devices_.front()->get(address, digits);
  }
  Status act(std::string_view action) override { return devices_.front()->act(action); }

 private:
  std::vector<std::unique_ptr<EmulatedDevice>> devices_;
};

}  // namespace fieldproof::plc
