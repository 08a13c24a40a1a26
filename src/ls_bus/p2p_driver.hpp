// The P2P driver 'LS Bus client': reads and writes words of an inverter (Cnet EN and KO chapter 8).
//
// A block has one variable of type word, single or continuous with 1 to 8 words: R and W know
// continuous words alone, and eight of them fill the longest frame (44 bytes). The partner's
// address is four hex digits, "1230".
//
// What a reply that is not the one asked for gives (Appendix 3.3; where several codes would
// fit: DECISIONS.md p2p/wrong-driver, p2p/check-first, p2p/reply-length):
//   01  characters, but neither ACK nor NAK      02  no EOT before the inter-character time is over
//   03  sum                                      04  another station
//   05  another command, or other data than written
//   0B  number of words, length of the frame, or a NAK whose code has not two characters
//   0D  station or data are not hex              0F  NAK
#pragma once

#include <memory>

#include "src/ls_bus/codec.hpp"
#include "src/p2p/driver.hpp"

namespace fieldproof::ls_bus {

/// `gap`: the inter-character time; chapter 8 has none of its own, so it is that of the channel
/// (4.3.1).
std::unique_ptr<p2p::P2pDriver> make_ls_bus_p2p_driver(LsWriteOrder write_order, Duration gap);

}  // namespace fieldproof::ls_bus
