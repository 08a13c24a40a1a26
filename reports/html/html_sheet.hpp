// What is printed and signed of a run with --qualify: identity, verdict and signatures on the first
// page, what was not judged on the second, then causes, sections, times, readings and errata.
#pragma once

#include "reports/html/html_survey.hpp"

namespace fieldproof::html {

void write_sheet(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate);

}  // namespace fieldproof::html
