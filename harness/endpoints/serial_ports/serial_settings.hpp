// What a serial driver is told and asked, by system calls that tests can replace.
#pragma once

#include <string>

#include "harness/system/system_calls.hpp"
#include "src/base/result.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

/// Is it the slave of a pty? It carries no parity, no 7-bit characters and no character times.
bool is_pty(const os::SystemCalls& calls, int fd);

/// Sets speed and character format, raw, without flow control. What the driver of a real port did
/// not take over is an error; a pty drops parity and 7 bits without a word, and here that is no
/// error. `port` is for messages.
Status apply_settings(const os::SystemCalls& calls, int fd, const std::string& port,
                      const line::LineSettings& settings);

/// Who drives the transmitter of a two-wire line.
enum class Direction {
  none,    // RS-232, RS-422, or an adapter that switches by itself
  kernel,  // TIOCSRS485: the driver raises RTS while it sends
  rts,     // we raise RTS while we send
};

/// `rs485` option: "" or "0", "1", "rts".
Result<Direction> parse_direction(const std::string& text);

/// Prepares the port for the direction control: RS-485 mode on, or RTS off (receive).
Status apply_direction(const os::SystemCalls& calls, int fd, const std::string& port,
                       Direction direction);
/// RTS on or off.
Status set_rts(const os::SystemCalls& calls, int fd, const std::string& port, bool on);

/// Counters of a driver since it was loaded.
struct LineErrorCounts {
  int parity = 0;
  int framing = 0;
  int breaks = 0;
  int overruns = 0;  // of the chip or of the kernel's buffer
};

/// False when the driver has no counters (a pty, some adapters).
bool read_line_errors(const os::SystemCalls& calls, int fd, LineErrorCounts& counts);

/// "3 parity errors, 1 break" between two readings, or empty.
std::string line_errors_between(const LineErrorCounts& before, const LineErrorCounts& after);

}  // namespace fieldproof::endpoints
