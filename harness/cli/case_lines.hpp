// Cases for the eye, one a line.
#pragma once

#include <string>
#include <vector>

#include "harness/vectors/case.hpp"

namespace fieldproof::cli {

/// Id, level, basis and title. On a terminal so wide (0: in a file) id and the beginning of the
/// title: ids are there to be copied and stay whole.
std::string case_lines(const std::vector<const vectors::Case*>& cases, int columns);

}  // namespace fieldproof::cli
