// The frame monitor's CSV file (Cnet KO 10.1.3).
#pragma once

#include <string>
#include <string_view>

#include "src/plc/frame_monitor.hpp"

namespace fieldproof::cli {

/// Begins the file anew; each frame is in it as soon as it is recorded. The time is the clock's,
/// and for a model without one that since the first frame. Errors name the file.
Result<plc::FrameMonitor::Record> open_monitor_file(const std::string& path,
                                                    std::string_view model);

}  // namespace fieldproof::cli
