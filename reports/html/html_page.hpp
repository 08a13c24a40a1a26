// What every HTML report looks like: one file, without network, and readable without a script.
#pragma once

#include <string>
#include <string_view>

#include "reports/html/html_writer.hpp"
#include "reports/results/verdict.hpp"

namespace fieldproof::html {

/// Doctype, head with the style sheet, and <body><main> around what `body` is. `script` stands in
/// this source, and in a CDATA section.
std::string html_page(std::string_view title, const HtmlWriter& body, std::string_view script = {});

/// The style sheet: colours of both schemes, tables, print. Classes are described in
/// html_style.cpp.
extern const char* const html_style;

/// The class of a verdict's colour: "v-pass", "v-non-strict".
std::string verdict_class(results::Verdict verdict);

/// <span class="verdict v-fail">FAIL</span>
void write_verdict(HtmlWriter& out, results::Verdict verdict);

}  // namespace fieldproof::html
