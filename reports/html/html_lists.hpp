// What a run met beside its verdicts: readings, errata, and the files that it speaks of.
#pragma once

#include <initializer_list>

#include "reports/html/html_survey.hpp"

namespace fieldproof::html {

/// <thead> of a table.
void write_head_row(HtmlWriter& out, std::initializer_list<const char*> heads);

void write_readings(HtmlWriter& out, const HtmlSurvey& survey);
void write_errata(HtmlWriter& out, const HtmlSurvey& survey);

/// SHA-256 of tool, vectors and profile as the run recorded them, and of its log.
void write_hashes(HtmlWriter& out, const HtmlSurvey& survey);

}  // namespace fieldproof::html
