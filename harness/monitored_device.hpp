// A device of a protocol behind a frame monitor.
#pragma once

#include "harness/protocol.hpp"
#include "src/plc/frame_monitor.hpp"

namespace fieldproof {

/// Protocol::make_device. With key "monitor": true in `config`, or a `record`, the device has a
/// FrameMonitor.
Result<std::unique_ptr<EmulatedDevice>> make_monitored_device(
    const Protocol& protocol, std::string_view model, nlohmann::json config,
    const FrameMonitor::Record& record = {});

}  // namespace fieldproof
