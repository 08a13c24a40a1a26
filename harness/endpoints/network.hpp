// Endpoints for protocols of networks: each connection and datagram port is a link.
#pragma once

#include "harness/endpoints/endpoint.hpp"
#include "harness/system/sockets/bench_sockets.hpp"

namespace fieldproof::endpoints {

/// What all of them have in common; who derives opens the links. `begin` of a case ends the links
/// that the bench has opened in the one before, and opens none.
class NetworkEndpoint : public Endpoint {
 public:
  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override { return name_; }
  Time now() const override { return sockets_.now(); }
  /// There are none.
  Duration character_time() const override { return {}; }
  Status begin(const nlohmann::json& config) override;
  Status close(LinkId link, Closing how) override { return sockets_.close(link, how); }
  using Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId link) override { return sockets_.send(bytes, link); }
  Result<Burst> receive(Time deadline) override { return sockets_.receive(deadline); }

 protected:
  /// `name` is for reports and messages: "tcp:plc:502".
  NetworkEndpoint(std::string name, const Capabilities& capabilities)
      : capabilities_(capabilities), name_(std::move(name)), sockets_(name_) {}

  os::BenchSockets& sockets() { return sockets_; }
  /// "cannot open a connection to ...: " and `why`.
  Error cannot_open(Transport transport, const std::string& why) const;

 private:
  Capabilities capabilities_;
  std::string name_;
  os::BenchSockets sockets_;
};

/// tcp:HOST[:PORT] and udp:HOST[:PORT] for a protocol that runs on a network: the device is the
/// server. Its name is looked up now; nothing is sent before the first link is opened. A link to
/// the protocol's port goes to the port of the name.
Result<std::unique_ptr<Endpoint>> open_network(const EndpointName& name,
                                               const harness::Protocol& protocol);

}  // namespace fieldproof::endpoints
