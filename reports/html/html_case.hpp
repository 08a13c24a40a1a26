// A case in HTML: a line where it passed, a block with its whole story where it did not plainly
// pass.
#pragma once

#include <string>

#include "reports/html/html_writer.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::html {

/// Bytes that are shown: of one frame in a block, and of all frames in a line. Who wants more reads
/// results.ndjson.
inline constexpr std::size_t block_frame_limit = 2048;
inline constexpr std::size_t line_bytes_limit = 128;

/// A row of a table: label, the bytes as they went over the line, milliseconds. Titles are
/// tooltips. `pictures`: of what a model did, behind a click.
void write_pass_line(HtmlWriter& out, const results::CaseResult& result, bool pictures = true);

/// A row of a table: verdict, label, and what is to be said of it in one line. `link` leads to its
/// block.
void write_case_line(HtmlWriter& out, const results::CaseResult& result,
                     const std::string& link = "");

/// How a block stands in its page.
struct CaseBlock {
  bool open = false;
  std::string id{};             // its anchor; empty: none
  std::string section_title{};  // of its clause
  bool wire = false;            // the exchange drawn on a time axis, too
};

/// <details>: title, clause and quote, the exchange as a frame monitor shows it with the bytes that
/// differ marked, differing fields, timing, readings, notes, replay command.
void write_case_block(HtmlWriter& out, const results::CaseResult& result, const CaseBlock& block);

}  // namespace fieldproof::html
