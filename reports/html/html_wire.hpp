// An exchange drawn on a time axis.
#pragma once

#include "reports/html/html_writer.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::html {

/// What it is drawn for: in a wide picture a telephone has no letters that can be read.
enum class WireOn { window, telephone };

/// A figure with two lanes, what the bench sent above what the device sent, silences with their
/// length, and the time within which the answer of the failing step was due. Long silences are cut.
/// Nothing where no frame went over the line.
void write_wire(HtmlWriter& out, const results::CaseResult& result, WireOn on);

}  // namespace fieldproof::html
