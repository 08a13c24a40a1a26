// Devices that are set up: clients that ask their partner, and the back door by which a bench sets
// a device up.
#pragma once

#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

/// The first two bytes choose a configuration of the vectors whose blocks ask again and again, the
/// rest are the partner's answers in pieces. It asks on behind them.
void feed_client(ByteView input);
std::vector<Bytes> good_partners();

/// The first byte chooses the protocol, the rest are lines of `emulate --control -`. What is
/// answered can be read, and the device runs on.
void feed_control(ByteView input);
std::vector<Bytes> good_controls();

}  // namespace fieldproof::fuzz
