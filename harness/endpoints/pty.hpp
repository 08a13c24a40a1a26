// pty:MODEL?options: the emulator in its own process behind a pty, on real time.
#pragma once

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// Starts this program (or the one that the environment variable FIELDPROOF_EXECUTABLE names) as
/// `emulate MODEL?options --control FD --tty PATH`. Each case begins with a fresh device; set, get
/// and act go over the control socket (device_control.hpp). Options: floor_ms, and the keys of
/// `given.config` (vectors/README.md) as defaults of each case. Without MODEL the case's "model"
/// decides.
Result<std::unique_ptr<Endpoint>> open_pty(const EndpointName& name);

}  // namespace fieldproof::endpoints
