// What became of all mutants, for people and for programs.
#pragma once

#include <string>
#include <vector>

#include "suites/mutants/hunt.hpp"

namespace fieldproof::mutants {

/// Markdown: by protocol, by file, by section of the manuals, and each that lives. `stages`: the
/// names, in their order.
std::string markdown(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes,
                     const std::vector<std::string>& stages);

/// A list of all.
std::string json_text(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes);

/// "XGT Cnet: 96.1 % of 812 killed by vectors, 98.0 % with derived": a line a protocol, and one for
/// all. Equivalent mutants do not count.
std::string summary(const std::vector<Mutant>& mutants, const std::vector<Outcome>& outcomes,
                    const std::vector<std::string>& stages);

}  // namespace fieldproof::mutants
