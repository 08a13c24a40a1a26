// `run --matrix`: the line settings that a run repeats its cases with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/line/settings.hpp"

namespace fieldproof::run {

/// Reads "SPEEDS x FRAMES": "38400,115200 x 8N1,8E1" is four steps, speed by speed; "all" stands
/// for all of a list, and alone for both (8 speeds by 12 frames). Errors name the part that is
/// wrong.
Result<std::vector<line::LineSettings>> parse_line_matrix(std::string_view text);

/// "38400 x 8N1": the matrix of this step alone.
std::string matrix_text(const line::LineSettings& step);

}  // namespace fieldproof::run
