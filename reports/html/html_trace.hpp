// Pictures of what a model did while a case ran, as SVG: how axes moved, and who had the token.
#pragma once

#include "reports/html/html_writer.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::html {

/// <figure>s: position above speed over one axis of time, one colour an axis of the motion bus,
/// limits dashed, events as numbered marks that a list below explains; a band for each station of a
/// net, stronger where it carried. Times are those of the monitor. Nothing where there is no trace.
void write_trace(HtmlWriter& out, const results::CaseResult& result);

}  // namespace fieldproof::html
