// A serial port, opened for this process alone: by a bench, or by a device that is emulated on it.
#pragma once

#include <memory>
#include <string>

#include "harness/endpoints/serial_ports/receive_latency.hpp"
#include "harness/system/port_lock.hpp"
#include "harness/system/system_calls.hpp"
#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

/// In the order in which it is taken; it is given up the other way round: the port is free when its
/// lock is.
struct SerialPort {
  os::PortLock lock;
  os::UniqueFd fd;
  std::unique_ptr<ReceiveLatency> latency;  // nullptr: a pty
};

/// Locked and exclusive (whoever opened it gives that up with TIOCNXCL), set to `settings`, and
/// told to hand over at once. Errors name who has the port, or which there are; `absent`: there is
/// no such port, or nothing behind its name.
Result<SerialPort> open_serial_port(const os::SystemCalls& calls, const std::string& path,
                                    const line::LineSettings& settings);

/// For messages: "these are there: /dev/serial/by-id/...", or what to plug in.
std::string serial_ports_there();

}  // namespace fieldproof::endpoints
