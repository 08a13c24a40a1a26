// The mistakes of the makers' manuals (vectors/errata): data for the makers, and for the reader of
// a report who has the manual open.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/vectors/json/shape.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof::vectors {

/// What an erratum is; vectors/errata.schema.json says the same to editors, which a test holds to.
const Shape& erratum_shape();

/// Adds those of one file; `file` is for messages. What is wrong with one is among `problems`, and
/// does not hide the others.
void load_errata(std::string_view text, const std::string& file, VectorSet& set);

/// Statement ids that it names.
std::vector<std::string_view> statements_of(const Erratum& erratum);

/// Gives each passage that only names a statement the statement's manual, section and quote. One
/// that there is not stays empty; lint_errata names it.
void resolve_errata(VectorSet& set);

/// Statements and manuals that errata cite are there, and fit; ids are unique.
std::vector<std::string> lint_errata(const VectorSet& set);

}  // namespace fieldproof::vectors
