// User-defined frames taken apart for people: `frame`, the field-by-field difference, the end of a
// frame.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "harness/protocol.hpp"
#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::user_frames_suite {

/// Length of the longest frame of any definition that `bytes` begin with; its check is not judged.
std::optional<std::size_t> frame_length(std::span<const NamedDefinition> definitions,
                                        ByteView bytes);

/// The parts of the frame of any definition that `frame` is, or comes nearest to; last "frame",
/// which names it.
std::vector<harness::Field> explain(std::span<const NamedDefinition> definitions, ByteView frame);

/// What the device stores when it receives `request`: the variables of the frame of `definition`
/// that it is, with a right check or not. Area "?" where it is none.
std::vector<harness::Protocol::Written> written_by(const NamedDefinition& definition,
                                                   ByteView request);

}  // namespace fieldproof::user_frames_suite
