// User-defined frames (Cnet EN 6.2.5, Cnet KO 6.5) for the harness. Models are definitions:
// definitions/README.md.
#pragma once

#include "harness/protocol.hpp"

namespace fieldproof::user_frames_suite {

/// On a serial line, or by TCP and UDP (FEnet EN 7.7).
enum class Way { line, network };

/// Knows the frames of all shipped definitions, and has no probe. "user-frames", "user-frames-net".
const harness::Protocol& protocol(Way way = Way::line);

/// Knows the frames of one model alone, with its probe and what its frames write; `protocol()`
/// where it cannot be read.
const harness::Protocol& protocol_of(std::string_view model, Way way = Way::line);

}  // namespace fieldproof::user_frames_suite
