// Facts of `table` vectors about user-defined frames (definitions/README.md 'Facts').
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::user_frames_suite {

/// The error says what is held instead.
Status check_fact(const nlohmann::json& facts);

}  // namespace fieldproof::user_frames_suite
