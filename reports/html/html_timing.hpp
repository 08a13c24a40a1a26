// Response times as small plots: one row a group of cases, all on one logarithmic scale so that
// they compare at sight.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "reports/html/html_writer.hpp"

namespace fieldproof::html {

/// The value below which `part` (0 to 1) of the sorted values lie, by nearest rank. `sorted` is not
/// empty.
double percentile(const std::vector<double>& sorted, double part);

/// A table: group, plot (histogram, quartiles, median, the limit as a dashed line), count, least,
/// median, 99th percentile, greatest. `limit_ms`: 0 where none is known.
void write_timing(HtmlWriter& out, const std::map<std::string, std::vector<double>>& response_ms,
                  double limit_ms);

}  // namespace fieldproof::html
