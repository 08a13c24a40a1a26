// Which servers answer at an address of a network, up to which sizes, and what stands in the way of
// those that do not. Only reads are sent.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "harness/protocols.hpp"

namespace fieldproof::probe {

/// The endpoint for one protocol; errors are trouble of the bench ("cannot find host").
using NetworkOpener =
    std::function<Result<std::unique_ptr<endpoints::Endpoint>>(const harness::Protocol& protocol)>;

/// What came of one port.
struct ServerFinding {
  enum class Kind {
    server,       // answers in the protocol of the port
    other,        // answers in another one
    refused,      // nothing listens there
    unreachable,  // nobody answers the attempt to connect: switched off, or filtered
    ended,        // takes the connection and ends it: host table, or all channels are taken
    silent,       // takes it, and answers nothing
    garbage       // answers what is no reply in any protocol
  };
  Kind kind = Kind::silent;
  const harness::Protocol* protocol = nullptr;  // server, other: the one that answers; else asked
  Transport transport = Transport::tcp;
  std::uint16_t port = 0;  // the protocol's, as the endpoint maps it
  std::string text;        // one sentence
  std::string advice{};    // what to do; empty where there is nothing to do
  std::vector<std::string>
      limits{};  // of a server: "most bytes of a continuous read: 512, as printed"

  bool is_server() const { return kind == Kind::server; }
};
std::string_view to_string(ServerFinding::Kind kind);

/// Does it run on a network, and has it a harmless request?
bool is_network_server(const harness::Protocol& protocol);

/// Looks for a server of each protocol where the endpoint for it leads to, over connections and
/// where the endpoint has them over datagrams, and at one that answers nothing for the other known
/// protocols. `wait`: for the first byte of an answer. Errors are trouble of the bench, or
/// interrupted.
Result<std::vector<ServerFinding>> find_servers(const NetworkOpener& open,
                                                const std::vector<const harness::Protocol*>& wanted,
                                                const harness::Protocols& known, Duration wait);

}  // namespace fieldproof::probe
