// The run as one HTML file: for the gate, for the engineer at the bench, and for whoever signs.
#pragma once

#include <memory>
#include <string>

#include "reports/results/sink.hpp"

namespace fieldproof::html {

/// Writes `path`: verdict and device at the top, what is red first, then sections of the manuals by
/// verdict, response times, readings, errata, what was not executed; where the gate of the run is
/// `qualify` as a sheet to sign. No script, no network; well-formed XML. What one file cannot hold
/// (frames, lines and blocks beyond the limits of html_case.hpp and html_survey.hpp) is counted and
/// said. `path` appears at the end, whole or not at all.
std::unique_ptr<results::Sink> html_report(const std::string& path);

}  // namespace fieldproof::html
