// The run as one HTML file: for the gate, for the engineer at the bench, and for whoever signs.
#pragma once

#include <string>

#include "reports/text/tally.hpp"
#include "src/base/result.hpp"

namespace fieldproof::html {

/// Reads the results in `ndjson` (of a killed run too) and writes `path`: verdict and device at the
/// top, what is red first, then sections of the manuals by verdict, response times, readings,
/// errata, what was not executed; with `gate.qualify` as a sheet to sign. No script, no network;
/// well-formed XML. What one file cannot hold (frames, lines and blocks beyond the limits of
/// html_case.hpp and html_survey.hpp) is counted and said. `path` appears whole or not at all.
/// Returns the counts of what was read.
Result<text::Tally> write_html(const std::string& ndjson, const std::string& path,
                               const results::Gate& gate);

}  // namespace fieldproof::html
