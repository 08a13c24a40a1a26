// A device of a protocol behind a frame monitor.
#pragma once

#include "harness/protocol.hpp"
#include "src/plc/frame_monitor.hpp"

namespace fieldproof::harness {

/// Protocol::make_device. With key "monitor": true in `config`, or a `record`, the device has a
/// FrameMonitor.
Result<std::unique_ptr<plc::EmulatedDevice>> make_monitored_device(
    const Protocol& protocol, std::string_view model, nlohmann::json config,
    const plc::FrameMonitor::Record& record = {});

}  // namespace fieldproof::harness
