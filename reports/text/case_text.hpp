// A case in words, frames and numbers: the block that the console prints and that stands in the
// body of a JUnit failure.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "reports/results/case_result.hpp"

namespace fieldproof::text {

struct CaseTextOptions {
  std::size_t limit =
      0;  // bytes of a frame that are shown; 0: all, but of more than 4096 an extract
  bool exchange =
      false;  // the exchange in any case; else only where a case sends more than one frame
  std::size_t width = 0;      // of the terminal: for bytes and tables; 0: as wide as they are
  bool frames_above = false;  // the judged frames stand there already: the exchange names them
};

/// One line of text that may be long, cut where the frame that it is about would be.
std::string shorten(const std::string& text, const CaseTextOptions& options);

/// "xgt_cnet/rss/two_words", with the step of a line matrix: "xgt_cnet/rss/two_words [38400-8N1]".
std::string case_name(const results::CaseResult& result);

/// The name, with " #2" for its first repetition.
std::string case_label(const results::CaseResult& result);

/// Folder and group of an id: "xgt_cnet/rss".
std::string group_of(const std::string& id);

/// One line: what is wrong; the verdict's word where nothing is said.
std::string case_message(const results::CaseResult& result);

/// "reply after 4.208 ms"; of many, how many with least, greatest and median. Empty without a
/// reply.
std::string case_timing(const results::CaseResult& result);

/// Title, clause and quote, sent, expected and received frames (notation, and hex with the bytes
/// that differ marked), differences as a table, timing, readings, notes and replay command. What is
/// not known is left out.
///
///   Read one word from M20 and one from P001 of station 1
///   clause    xgb-cnet-en-1.6, 7.1.5 (1)(e) (must, printed rule)
///             "This example supposes when 1 WORD from M20 ..."
///   sent      ENQ '01rSS0206%MW02006%PW001' EOT '68'
///             05 30 31 ...
///   ...
///
/// Each line ends with a line feed; only characters that xml_text allows.
std::string case_block(const results::CaseResult& result, const CaseTextOptions& options = {});

/// The exchange as a frame monitor shows it: time since its first event, gap since the frame before
/// it (ms), direction.
std::string frame_monitor(const results::CaseResult& result, const CaseTextOptions& options = {});

/// Hex in lines of 16 bytes, 8 where `width` is less, with offsets where there is more than one
/// line: "06 30 31 ...". Of an extract, or of more than 4096 bytes, both ends, how many they are,
/// and their SHA-256.
std::string hex_dump(ByteView bytes, const CaseTextOptions& options = {},
                     const results::Extract& extract = {});

/// Each line that is not empty moved to the right.
std::string indent(std::string_view lines, std::size_t columns);

}  // namespace fieldproof::text
