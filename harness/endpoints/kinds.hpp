// The table of the kinds of endpoint, and what each can do. Nobody asks for a kind by its name.
#pragma once

#include <span>

#include "harness/endpoints/endpoint.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

/// How an endpoint is told the speed and format of its line.
enum class LineOption {
  none,    // it has none to set
  device,  // option `line`: of the emulated device, and so of the bench
  port     // options `baud` and `frame`: of the bench's own port
};

struct KindOf {
  std::string_view name{};
  std::string_view target{};  // what stands behind the colon, for messages; empty: it may be left
                              // out
  std::span<const std::string_view> options{};  // empty: the emulated device checks them (keys of
                                                // `given.config`)
  bool free_target = false;  // the target may hold '?' and '&' of its own: only known options count
                             // as options

  LineOption line = LineOption::none;
  bool emulated = false;     // our own device: options describe it, cases configure it
  bool simulated = false;    // time costs nothing
  bool back_door = false;    // memory and mode are reached past the wire
  bool can_restart = false;  // the device can be switched off and on
  bool local_port = false;   // the target is a port of this computer
  bool lines = false;        // carries protocols of serial lines
  bool connections = false;  // carries those of networks, over connections
  bool datagrams = false;    // and over datagrams
  bool listens = false;      // the device opens the links: it is a client

  /// A program that the bench starts, and that ends with it.
  bool started_by_bench() const { return can_restart && !emulated; }

  /// What is wrong with target and options before anything is opened; with a protocol that the
  /// flags let pass.
  Status (*check)(const EndpointName&) = nullptr;
  Status (*check_protocol)(const EndpointName&, const harness::Protocol&) = nullptr;
  Result<std::unique_ptr<Endpoint>> (*open)(const EndpointName&,
                                            const harness::Protocol&) = nullptr;
};

std::span<const KindOf> all_kinds();
/// Of a name that parse_endpoint has read; of another kind: one that can do nothing.
const KindOf& kind_of(const EndpointName& name);

/// What the kind can do, as far as that is settled before it is opened; timing_floor is left out.
Capabilities capabilities_of(const EndpointName& name);

/// Can this endpoint carry this protocol, and is it known where? Errors say what to write instead.
Status check_endpoint(const EndpointName& name, const harness::Protocol& protocol);

/// Are its options such that it can be opened? Nothing is opened for that.
Status check_options(const EndpointName& name, const harness::Protocol& protocol);

/// The protocol by which a real device of `protocol` is asked there: itself, or what carries it.
const harness::Protocol& spoken_over(const EndpointName& name, const harness::Protocol& protocol);

/// The endpoint with the bench's own side of the line, and of an emulator the device's too, set so.
/// Kinds without line settings stay as they are.
EndpointName with_line(EndpointName name, const line::LineSettings& settings);

}  // namespace fieldproof::endpoints
