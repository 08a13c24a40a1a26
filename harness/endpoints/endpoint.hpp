// Where the bytes of a case go to and come from. An endpoint knows no protocol.
#pragma once

#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/base/trace.hpp"
#include "src/line/device.hpp"

namespace fieldproof::harness {
class Protocol;
}

namespace fieldproof::endpoints {

/// What an endpoint can and cannot show, so that no case is judged on what the link does not carry.
struct Capabilities {
  bool simulated = false;  // time costs nothing and is exact
  bool wire = false;  // character times, parity and data bits exist (simulated line, real adapter)
  bool paced =
      false;  // a real line: a request is over when its characters can have gone at its speed
  bool back_door = false;  // emulator: memory, counters and configuration can be set for each case
  bool control = false;    // real device: a program beside it reaches what its protocol does not
  bool real_device = false;  // the write fence binds; configuration is what is declared
  bool can_power_cycle = false;
  bool renews = false;       // as far as it is known, see Endpoint::renew
  bool connections = false;  // links are opened and closed (TCP); there is no line 0
  bool datagrams = false;    // one send is one packet (UDP)
  bool shared = false;       // a line behind a serial server, which may let others in, too
  Duration round_trip{};     // to that server, as TCP has measured it
  /// Differences in time below this cannot be judged (0 in simulation).
  Duration timing_floor{};
  /// Silence inside a frame that the driver may make itself; nothing: not known, timing_floor
  /// holds.
  std::optional<Duration> driver_silence{};
  std::string driver_silence_by{};  // "rx_trig_bytes 8, which root can set to 1"
  std::string line{};               // that a real port was opened with: "9600-8N1"
};

class Endpoint {
 public:
  virtual ~Endpoint() = default;

  virtual const Capabilities& capabilities() const = 0;
  /// For reports: "pty: emulator xbc-h", "serial:/dev/ttyUSB0 38400-8N1".
  virtual std::string describe() const = 0;
  virtual Time now() const = 0;
  /// One character on this line.
  virtual Duration character_time() const = 0;

  /// Answers came before a request could be over at this speed: no wire paces what goes over this
  /// port, whatever its driver says of itself.
  virtual void has_no_wire() {}

  /// Starts a case. Emulators become a fresh device with `config` (vectors/README.md,
  /// `given.config`, with "model"). Real devices are given what they can be given of it: it is all
  /// that the device is to have; what else differs, the runner has compared with what is declared.
  /// Nothing is purged. Errors that are `refused`: the device cannot be set up so.
  virtual Status begin(const nlohmann::json& config) = 0;
  /// Does begin() give a real device this key of `given.config`?
  virtual bool configures(std::string_view) const { return false; }
  /// How often the device under test was started by this endpoint: what it knew before is gone.
  virtual unsigned starts() const { return 0; }
  /// What was sent last to a device that this endpoint has started, while it ran; empty: nothing.
  virtual Bytes last_sent() const { return {}; }
  /// What begin(config) starts the device under test with: between cases alike in it none is
  /// started. Empty: no configuration wants a start.
  virtual std::string started_with(const nlohmann::json&) const { return {}; }

  /// Opens a connection to `port` of the device, or a datagram port of the bench that talks to it
  /// (capabilities().connections, .datagrams); 0: the port of the endpoint's name, else of its
  /// protocol. A refused connection is no error: the link is there, and the first burst on it is
  /// `reset`. Errors are trouble of the bench ("no route", "cannot resolve").
  virtual Result<LinkId> open(Transport transport, std::uint16_t port);
  /// Was the last connection that was opened refused: does nothing listen on its port? One that is
  /// taken and then reset was not.
  virtual bool was_refused() const { return false; }
  /// The line of another serial channel of the device, by itself a link. Errors: nobody leads
  /// there.
  virtual Result<LinkId> open_line(unsigned channel);
  /// Errors: the link is not open.
  virtual Status close(LinkId link, Closing how);

  /// Transmits now, on an open link. Errors are trouble of the port, never of the device; what is
  /// sent on a link that the device has ended is dropped.
  virtual Result<Sent> send(ByteView bytes, LinkId link) = 0;
  Result<Sent> send(ByteView bytes) { return send(bytes, line_link); }
  /// Waits until `deadline` (a moment in the past: takes what is there) for what the device does
  /// next on any link: bytes, a datagram, FIN, RST, or a connection of its own. An empty burst of
  /// event `data`: nothing came. Ctrl-C ends the wait with an interrupted error.
  virtual Result<Burst> receive(Time deadline) = 0;

  /// Back door (capabilities().back_door, .control); errors name the address or action, and are
  /// `refused` where the device has no such thing.
  virtual Status set(std::string_view address, std::string_view hex);
  virtual Result<std::string> get(std::string_view address, std::size_t digits);
  virtual Status act(std::string_view action);
  /// Off and on by a word to the device, which answers when it is up (capabilities().renews): no
  /// request that looks for it moves its counters. Errors that are `refused`: it knows no such
  /// word.
  virtual Status renew();
  /// The device has lost its power: what was open leads nowhere any more.
  virtual void lose_links() {}
  /// Puts back what set() has changed in a real device since the case began.
  virtual Status put_back() { return ok(); }
  /// What moved since the case began, and who had the token (EmulatedDevice::trace).
  virtual Trace trace() const { return {}; }

  /// A line to the standard input of the device under test, where the endpoint has started it
  /// (`--stimulus -`).
  virtual Status tell(std::string_view line);
  /// The first line of its standard output that begins with '{'; empty: none came within that time.
  virtual std::string answer(Duration patience);

  /// capabilities().shared: does the server take one more client now? Then somebody else may be
  /// heard on the line.
  virtual bool lets_others_in() { return false; }

  /// Errors that the driver has counted since the last call ("3 parity errors, 1 break"), or empty.
  virtual std::string line_errors();
};

/// "pty:xbc-h?station=1&protocol=xgt-cnet" taken apart.
struct EndpointName {
  std::string kind;                            // "pty"
  std::string target;                          // "xbc-h"
  std::map<std::string, std::string> options;  // station, protocol, ...

  /// The option, or `fallback`.
  std::string option(const std::string& key, const std::string& fallback) const;
};

/// Errors name the part that is wrong and the kinds or options there are.
Result<EndpointName> parse_endpoint(std::string_view text);

/// Opens an endpoint by the table in endpoint.cpp: one line a kind. It is to carry `protocol`,
/// which makes the devices that are emulated in process.
Result<std::unique_ptr<Endpoint>> open_endpoint(const EndpointName& name,
                                                const harness::Protocol& protocol);

}  // namespace fieldproof::endpoints
