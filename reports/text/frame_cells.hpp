// The frames of a failing step byte by byte, with those marked that differ: for the console's dump
// and for HTML.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"

namespace fieldproof::text {

/// "06", or "??" for a byte that the notation leaves open, or "--" for one that is missing.
struct FrameCell {
  std::string text;
  bool marked = false;
};
using FrameCells = std::vector<FrameCell>;

FrameCells cells_of(ByteView bytes);

struct JudgedFrames {
  std::optional<FrameCells>
      expected;         // nothing: the expectation is no list of bytes (alternatives in words, say)
  FrameCells received;  // marked: each byte that differs; the first alone where the lengths differ;
                        // of an extract its head
};
JudgedFrames judged_frames(const results::CaseResult& result);

/// A step expected a frame, or got one that it did not.
bool has_judged_frames(const results::CaseResult& result);

}  // namespace fieldproof::text
