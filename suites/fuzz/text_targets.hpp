// What people type: command lines, the values of their options, frames in any form.
#pragma once

#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

/// A word a line. The command is found, or what is wrong is said; it is not begun.
void feed_command(ByteView input);
std::vector<Bytes> good_commands();

/// Endpoints, line settings, matrices, durations, ranges that may be written, axes.
void feed_options(ByteView input);
std::vector<Bytes> good_options();

/// What a frame monitor shows of bytes reads as the same bytes.
void feed_monitor(ByteView input);
std::vector<Bytes> good_monitors();

}  // namespace fieldproof::fuzz
