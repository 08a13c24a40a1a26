// A definition of user frames as JSON (suites/user_frames/definitions/README.md).
#pragma once

#include <string>

#include "src/base/result.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

/// Reads a definition and keeps the limits of Cnet KO 6.5.1. `file` is its name in messages, which
/// also name group, frame, segment and key.
Result<FrameDefinition> parse_frame_definition(const std::string& text, const std::string& file);

}  // namespace fieldproof::user_frames
