// The part of the report that is printed and signed: what was not judged and why, which readings
// the device takes, which errata were met, and the hashes that say which files all this speaks of.
#pragma once

#include <string>

#include "reports/html/html_survey.hpp"

namespace fieldproof::html {

void write_unexecuted(HtmlWriter& out, const HtmlSurvey& survey);
void write_readings(HtmlWriter& out, const HtmlSurvey& survey);
void write_errata(HtmlWriter& out, const HtmlSurvey& survey);

/// SHA-256 of tool, vectors and profile as the run recorded them, and of its log.
void write_hashes(HtmlWriter& out, const HtmlSurvey& survey);

/// The declared fingerprint beside the found one, and the lines to sign.
void write_fingerprint(HtmlWriter& out, const results::Identity& identity);
void write_signatures(HtmlWriter& out);

}  // namespace fieldproof::html
