// The top of the report: what a reader must see without scrolling.
#pragma once

#include "reports/html/html_survey.hpp"

namespace fieldproof::html {

/// The verdict of the gate, why, and the counts by verdict with their meaning.
void write_verdict_of_run(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate);

/// Device and run as two tables: identity as entered, endpoint, profile, station; date, duration,
/// versions, gate.
void write_facts(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate);

/// "LS XBC-DN32H, firmware V1.8", or the endpoint where no identity was entered.
std::string device_title(const results::RunInfo& run);

/// One line a verdict, those that did not occur too.
void write_legend(HtmlWriter& out, const results::Gate& gate);

}  // namespace fieldproof::html
