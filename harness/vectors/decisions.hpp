// DECISIONS.md: what was decided where the manuals are silent, and that vectors cite it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/vectors/binding.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::vectors {

/// The entries of DECISIONS.md, in its order. An entry is a heading "### ID"; the line behind it is
/// its first sentence, empty where there is none.
std::vector<Decision> read_decisions(std::string_view markdown);

/// Adds the entries of `file` to those of `set`, and their sentences to the cases that cite them.
/// An id that the set knows already keeps its entry, so that the decisions of the vectors' own
/// folder come before the tool's. A file that is not there has none.
void load_decisions(const std::filesystem::path& file, VectorSet& set);

/// Cited decisions exist, a vector whose basis is a decision cites one, and every entry has an id
/// of small letters and a first sentence.
std::vector<std::string> lint_decisions(const VectorSet& set);

/// Every decision that a device is held to by name exists; the error suggests a near one.
Status check_binding(const Binding& binding, const VectorSet& set);

}  // namespace fieldproof::vectors
