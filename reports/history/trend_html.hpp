// The trend of a device as one HTML file, in the look of the other reports.
#pragma once

#include <string>

#include "reports/history/trend.hpp"

namespace fieldproof::history {

/// Changes first, then totals and topics as curves over the runs (those that changed in sight, the
/// others folded), flaky cases, firmware versions and runs. No script, no network.
std::string trend_html(const Trend& trend);

}  // namespace fieldproof::history
