// The P2P driver 'user frame definition': SEND and RECEIVE blocks (Cnet EN 6.2.4 3), 4); Cnet
// KO 6.5.5).
//
// SEND builds its frame from memory and is done with that; nothing is waited for. RECEIVE is always
// armed: a frame that comes whole and with a right check is stored, whether anybody asked for it or
// not. A frame that has no RECEIVE block is not looked for. A frame with a wrong check is ignored
// (Cnet KO 6.5.1).
//
// Where the definition says `"memory": true`, the block gives the addresses, in the order of the
// variables (READ1, SAVE1 of figures 6.2.8 and 6.2.9), and its `size` is that of the sent variable
// whose size is open (SIZE1).
//
// What is received but cannot be stored ends RECEIVE with 0D (no hex digits) or 0E (the area ends
// before).
#pragma once

#include <memory>
#include <span>

#include "src/p2p/driver.hpp"
#include "src/user_frames/frame.hpp"

namespace fieldproof::user_frames {

/// `blocks`: whose RECEIVE blocks arm a frame. `gap`: the inter-character time.
std::unique_ptr<p2p::P2pDriver> make_user_frame_p2p_driver(FrameDefinition definition,
                                                           std::span<const p2p::P2pBlock> blocks,
                                                           Duration gap);

/// The same on a network (FEnet EN 7.7.5): a datagram is a frame, and bytes of none are passed over
/// without an end of the connection. `gap` is the silence that ends a frame without an end.
std::unique_ptr<p2p::P2pDriver> make_user_frame_network_driver(
    FrameDefinition definition, std::span<const p2p::P2pBlock> blocks, Duration gap);

}  // namespace fieldproof::user_frames
