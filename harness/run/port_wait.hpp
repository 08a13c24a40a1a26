// --wait-port: a port that is absent or in use is waited for.
#pragma once

#include "harness/run/run_plan.hpp"

namespace fieldproof::run {

/// Until the port of each device of the plan can be opened, at most for plan.wait_port in all; none
/// stays open. A port of this computer is tried again when the system tells that something happened
/// there, a server on the network once a second; what the bench makes itself is not waited for. The
/// error is that of a device alone, or an interrupt: of several, the others go on.
Status await_ports(const RunPlan& plan);

}  // namespace fieldproof::run
