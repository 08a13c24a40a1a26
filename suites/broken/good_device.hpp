// The good device behind a fault: asked one frame at a time, on a clock of its own.
#pragma once

#include <memory>

#include "src/plc/emulated_device.hpp"

namespace fieldproof::broken {

class GoodDevice {
 public:
  explicit GoodDevice(std::unique_ptr<plc::EmulatedDevice> device) : device_(std::move(device)) {}

  /// What it answers to a frame; empty: silence.
  Bytes answer(ByteView frame);
  /// The back door.
  plc::EmulatedDevice& memory() const { return *device_; }

 private:
  std::unique_ptr<plc::EmulatedDevice> device_;
  Time now_{};
};

}  // namespace fieldproof::broken
