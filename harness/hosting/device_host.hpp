// An emulated device on real time, behind a pty, a terminal or a socket: the loop of the `emulate`
// command.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "src/base/burst.hpp"
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

/// What crossed at once, as a frame monitor shows it.
struct Traffic {
  Time moment{};           // since the start
  bool to_device = false;  // received by the device, or done by it
  ByteView bytes{};
  LinkEvent event = LinkEvent::data;
  std::string link{};  // "#1 127.0.0.1:40312"; empty: the line
  bool stands = true;  // of a connection of the device's own: else these bytes wait, and of a
                       // reset: it never stood
};

/// "    12.345 ms  received   20  05 30 31 ...  .01rSS..." on one line, without newline; of a link
/// "    12.345 ms  #1 127.0.0.1:40312  received ...", or what happened on it: "connected", "closed
/// by the client (FIN)", "reset by the device (RST)". Bytes that have not left are "waiting".
std::string monitor_line(const Traffic& traffic);

struct HostOptions {
  HostedFactory make_device;
  std::string model;  // empty: "model" of the configuration
  nlohmann::json config =
      nlohmann::json::object();  // of the first device, and defaults for those of `begin`
  std::string pty, tty;          // --pty and --tty PATH, see host_on_tty
  std::string tcp, udp;          // --tcp and --udp HOST:PORT; port 0: any; no host: loopback
  std::uint16_t port = 0;        // of the device's protocol: it runs on a network; 0: on a line
  std::uint16_t udp_port = 0;    // where it takes datagrams
  std::string bus;               // --bus HOST:PORT: BusLink; empty: its fieldbus ends here
  int control = -1;  // --control FD, taken over; its end ends the host. 0: standard input,
                     // answered on standard output
  std::function<void(const Traffic&)> monitor;     // -v; may be empty
  std::function<void(std::string_view line)> say;  // where it listens; empty: standard output
};

/// Runs a device until SIGINT, SIGTERM, `interrupt()`, or the end of the control socket: 0. SIGHUP
/// switches the device off and on. 2: the options make no device; 3: trouble of the port. Reasons
/// go to standard error.
///
/// `tty` is a terminal that is there: a real port is opened with config "line", locked against
/// others. Where there is nothing at the path `pty`, or a link to nothing, a new pty is made and
/// the path becomes a link to its slave, removed at the end. Without both, a new pty is made and
/// its path said.
int host_on_tty(const HostOptions& options);

/// The same behind a listening socket. To a device on a line several clients may be connected: it
/// hears them all, and what it sends goes to the one it heard last (to all before it heard any). To
/// a device on a network each connection is a link, and each sender of datagrams to `options.udp`;
/// where `pty` or `tty` is given as well, the line of its services is there.
int host_on_socket(const HostOptions& options);

/// On sockets where the device runs on a network, or `options.tcp` is given; else on a tty.
int host_device(const HostOptions& options);

}  // namespace fieldproof::hosting
