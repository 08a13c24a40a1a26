// Search, filter and sort: all that needs a script. Without one the page is read as it stands.
#pragma once

#include "reports/html/html_writer.hpp"

namespace fieldproof::html {

/// The form and the table of what was found, both hidden until the script shows them.
void write_find(HtmlWriter& out);

/// Fills them from the sections of the page; the address keeps what was asked
/// (`report.html#q=rss&verdict=FAIL&sort=-ms`).
extern const char* const html_script;

}  // namespace fieldproof::html
