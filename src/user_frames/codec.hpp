// Frames as bytes: built from memory, matched, checked and stored.
#pragma once

#include "src/base/result.hpp"
#include "src/plc/memory.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

/// How far bytes are a frame.
struct FrameMatch {
  enum class State { no, partial, complete };
  State state = State::no;
  std::vector<std::size_t> ends;  // offset behind each segment that was read, in order

  std::size_t length() const { return ends.empty() ? 0 : ends.back(); }
  /// The bytes of a segment that was read.
  ByteView part(ByteView frame, std::size_t segment) const;
};

/// Do `bytes` begin with `frame`, or could they? Constants are compared, checks are not. `ended`:
/// nothing more comes.
FrameMatch match_frame(const UserFrame& frame, ByteView bytes, bool ended = false);

/// The check that the frame should carry; empty where it has none. `match` is complete.
Bytes due_check(const UserFrame& frame, const FrameMatch& match, ByteView bytes);
/// Position of the check among the segments, or segments.size().
std::size_t check_position(const UserFrame& frame);
bool check_holds(const UserFrame& frame, const FrameMatch& match, ByteView bytes);

/// Stores the variables, all or none.
enum class Stored { yes, not_hex, beyond_area };
Stored store(const UserFrame& frame, const FrameMatch& match, ByteView bytes,
             plc::PlcMemory& memory);

/// The bytes of a sent frame. The error names the variable whose memory does not hold hex digits,
/// or is a P2P block's.
Result<Bytes> build_frame(const UserFrame& frame, const plc::PlcMemory& memory);

}  // namespace fieldproof::user_frames
