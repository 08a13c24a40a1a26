// The Ethernet module of a PLC: its services share one network. A connection or datagram goes to
// the service that listens on its port, and stays with it.
#pragma once

#include <map>
#include <vector>

#include "src/net/own_links.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::plc {

class Ethernet : public net::Host {
 public:
  /// `service` outlives the module.
  void add(NetworkService& service) { services_.push_back(&service); }
  bool empty() const { return services_.empty(); }
  /// For services that open links.
  net::OwnLinks& own_links() { return own_links_; }

  bool listens(Transport transport, std::uint16_t port) const override;
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

 private:
  NetworkService* owner(const Burst& burst);

  std::vector<NetworkService*> services_;
  std::map<LinkId, NetworkService*> owners_;
  net::OwnLinks own_links_;
};

}  // namespace fieldproof::plc
