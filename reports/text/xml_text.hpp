// Any bytes as text that XML 1.0, a terminal and a reader can bear.
#pragma once

#include <string>
#include <string_view>

namespace fieldproof::text {

/// UTF-8 of characters that XML 1.0 allows. What it forbids or discourages (control bytes other
/// than tab and line feed, DEL, U+0080-U+009F, U+FFFE, U+FFFF) and bytes that are not UTF-8 are
/// shown as hex, byte by byte: [05], [FF]. A carriage return is shown too: readers of XML turn it
/// into a line feed, and on a serial line it is data.
std::string xml_text(std::string_view bytes);

/// The same in one line, for attributes: tab and line feed are shown as [09] and [0A].
std::string xml_line(std::string_view bytes);

/// Appends text that is clean (one of the above) as content of an element, or as value of an
/// attribute in double quotes: & < > as entities, and in a value the quotes.
void append_content(std::string& xml, std::string_view clean);
void append_value(std::string& xml, std::string_view clean);

}  // namespace fieldproof::text
