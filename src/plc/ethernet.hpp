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
  /// `service` outlives the module. Errors: another one listens on a port of it.
  Status add(NetworkService& service);
  bool empty() const { return services_.empty(); }
  /// Links that are there; for tests.
  std::size_t links() const { return owners_.size(); }
  /// For services that open links.
  net::OwnLinks& own_links() { return own_links_; }

  bool listens(Transport transport, std::uint16_t port) const override;
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

 private:
  /// Whose a link is, and who has closed it: both, and it is gone (src/net/host.hpp).
  struct Owner {
    NetworkService* service = nullptr;
    bool closed_by_client = false, closed_by_us = false;
  };
  NetworkService* owner(const Burst& burst);
  void note(const Burst& burst, bool Owner::*closed);

  std::vector<NetworkService*> services_;
  std::map<LinkId, Owner> owners_;  // of the links that are there
  net::OwnLinks own_links_;
};

}  // namespace fieldproof::plc
