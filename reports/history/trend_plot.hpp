// A series over the runs as a picture.
#pragma once

#include "reports/history/trend.hpp"
#include "reports/html/html_writer.hpp"

namespace fieldproof::history {

/// A curve from zero up; lines where the firmware changes, and the change that was found. Of many
/// runs, neighbours are drawn as one point, their median.
void write_trend_plot(html::HtmlWriter& out, const Trend& trend, const Series& series);

}  // namespace fieldproof::history
