// Lines for a terminal: none wider than it is.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fieldproof::text {

/// Columns that UTF-8 takes on a terminal: two for a Hangul or Chinese character, none for a
/// colour.
std::size_t columns_of(std::string_view utf8);

/// Each line that is wider than `width` (0: none is) goes on in the next one, below the text that
/// its label leads to:
///
///   clause    xgb-cnet-en-1.6, 7.1.5 (1)(e)
///             (must, printed rule)
///
/// Commands of the tool behind a label are broken between words of the shell, and a word that is
/// wider than a line goes on at the beginning of the next one, so that they can be pasted.
/// Names (whatever has a slash) are never broken; other words only where they are wider than a
/// line.
std::string fold(std::string_view text, std::size_t width);

/// Words as a paragraph of lines that are indented by two, each ended.
std::string paragraph(const std::string& words, std::size_t width);

/// The first columns of a line, with "..." where there is more.
std::string cut(std::string_view line, std::size_t width);

}  // namespace fieldproof::text
