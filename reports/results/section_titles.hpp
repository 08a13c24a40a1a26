// What the sections of a manual are called.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace fieldproof::results {

/// Of one manual, by number: "7.1.5", "7.1.5 (1)", "Appendix 3.1", "1-2-3".
using SectionTitles = std::map<std::string, std::string>;

/// "7.1.5 (1)(e)" is within "7.1.5 (1)", "7.1.5", "7.1" and "7", and "7.1.5" within itself.
bool is_within(std::string_view section, std::string_view number);

/// The title that stands nearest above: of "7.1.5 (1)(e)" that of "7.1.5 (1)", else of "7.1.5", but
/// not of "7.1". Empty where there is none.
std::string_view title_of(const SectionTitles& titles, std::string_view section);

/// The chapter's part that a section is in: "7.1" of "7.1.5 (1)(e)", "1-2" of "1-2-3", "Appendix 3"
/// of "Appendix 3.1"; what has no number is its own.
std::string part_of(std::string_view section);

/// Whether it begins as a numbered section does, and so has a title.
bool is_numbered(std::string_view section);

}  // namespace fieldproof::results
