// The exchange of a case as a frame monitor shows it.
#pragma once

#include <string>

#include "reports/html/html_writer.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::html {

struct Direction {
  const char* arrow;
  const char* word;
};
Direction direction(results::Event::Kind kind);

/// "... 12 more bytes"
std::string more_bytes(std::size_t count);

/// A row a frame: time, gap, direction, notation and hex; what was expected above what was judged,
/// with the bytes that differ marked.
void write_monitor(HtmlWriter& out, const results::CaseResult& result);

}  // namespace fieldproof::html
