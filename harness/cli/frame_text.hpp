// A frame as people have it at hand: notation, hex, or what a frame monitor shows.
#pragma once

#include <string>

#include "harness/notation/frame_template.hpp"

namespace fieldproof::cli {

/// "[ENQ]01rSS[EOT]A4" or "<05>01": a frame monitor's text, with control names or hex in brackets.
Bytes read_monitor_text(const std::string& text);

/// Notation, hex or raw, in this order of likelihood.
Result<Bytes> read_frame_text(const std::string& text, const notation::Fields& stations);

}  // namespace fieldproof::cli
