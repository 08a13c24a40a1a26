// The frame of a SEND or RECEIVE block, with what the block says of its variables (Cnet EN 6.2.4,
// Cnet KO 6.5.5).
#pragma once

#include "src/base/result.hpp"
#include "src/p2p/block.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

/// Errors say what is wrong with `frame`, `read`, `save` or `size` of the block: an unknown frame,
/// one of the other direction, more or fewer addresses than variables without memory, addresses
/// that cannot hold them.
Result<UserFrame> frame_of_block(const FrameDefinition& definition, const p2p::P2pBlock& block);

}  // namespace fieldproof::user_frames
