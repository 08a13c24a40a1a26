// An emulated device on real time, behind a pty, a terminal or a socket: the loop of the `emulate`
// command.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/plc/emulated_device.hpp"

namespace fieldproof::hosting {

/// Makes a device from a merged configuration (vectors/README.md, `given.config`). It always has
/// "model" (a string), "station" (1 unless given) and "inter_character_floor_ms" (a number): behind
/// a pty or a socket, parts of one write arrive milliseconds apart.
using HostedFactory =
    std::function<Result<std::unique_ptr<plc::EmulatedDevice>>(const nlohmann::json& config)>;

/// Bytes that crossed the line at once, as a frame monitor shows them.
struct Traffic {
  Time moment{};           // since the start
  bool to_device = false;  // received by the device, or sent by it
  ByteView bytes;
};

/// "    12.345 ms  received   20  05 30 31 ...  .01rSS..." on one line, without newline.
std::string monitor_line(const Traffic& traffic);

struct HostOptions {
  HostedFactory make_device;
  std::string model;  // empty: "model" of the configuration
  nlohmann::json config =
      nlohmann::json::object();  // of the first device, and defaults for those of `begin`
  std::string tty;               // --tty PATH, see host_on_tty
  std::string tcp;               // --tcp HOST:PORT; port 0: any
  int control = -1;              // --control FD, taken over; its end ends the host
  int inter_character_floor_ms = 20;
  std::function<void(const Traffic&)> monitor;     // -v; may be empty
  std::function<void(std::string_view line)> say;  // where it listens; empty: standard output
};

/// Runs a device until SIGINT, SIGTERM, `interrupt()`, or the end of the control socket: 0. SIGHUP
/// switches the device off and on. 2: the options make no device; 3: trouble of the port. Reasons
/// go to standard error.
///
/// A `tty` that is a terminal is opened raw (a real one with config "line"). Where there is nothing
/// at that path, or a link to nothing, a new pty is made and the path becomes a link to its slave,
/// removed at the end. Without `tty`, a new pty is made and its path said.
int host_on_tty(const HostOptions& options);

/// The same behind a listening socket. Several clients may be connected: the device hears them all,
/// and what it sends goes to the one it heard last (to all before it heard any).
int host_on_tcp(const HostOptions& options);

/// By `options.tcp` or `options.tty`.
int host_device(const HostOptions& options);

}  // namespace fieldproof::hosting
