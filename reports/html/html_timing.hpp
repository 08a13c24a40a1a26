// Response times as small plots: one row a group of cases, all on one logarithmic scale so that
// they compare at sight.
#pragma once

#include <map>
#include <string>

#include "reports/html/html_writer.hpp"
#include "reports/results/case_result.hpp"
#include "reports/results/response_times.hpp"

namespace fieldproof::html {

/// A table: group, plot (histogram, quartiles, median, the limit as a dashed line), count, least,
/// median, 99th percentile, greatest. `limit_ms`: 0 where none is known.
void write_timing(HtmlWriter& out, const std::map<std::string, results::ResponseTimes>& response_ms,
                  double limit_ms);

/// The table with its heading and a line that explains it; nothing where no reply was timed.
void write_times(HtmlWriter& out, const std::map<std::string, results::ResponseTimes>& response_ms,
                 const results::RunInfo& run);

}  // namespace fieldproof::html
