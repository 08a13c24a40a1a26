// What turned the gate red, grouped by cause.
#pragma once

#include <vector>

#include "reports/html/html_survey.hpp"

namespace fieldproof::html {

/// A cause with its cases: what turns every gate red before what turns only this one red, and the
/// causes of many cases before the others.
struct RedCause {
  const text::Finding* finding = nullptr;
  const RedGroup* group = nullptr;
};
std::vector<RedCause> red_causes(const HtmlSurvey& survey);

/// "BCC: expected ..., got ...": the message, without the values in which its cases differ.
std::string cause_text(const text::Finding& finding);

/// A heading a cause that several cases have, with the first of them in full; then the others.
void write_red(HtmlWriter& out, const HtmlSurvey& survey, const results::Gate& gate);

}  // namespace fieldproof::html
