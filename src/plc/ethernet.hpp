// The Ethernet module of a PLC: its services share one network. A connection or datagram goes to
// the service that listens on its port, and stays with it. Where the host table is on, those of
// other addresses reach no service: a connection is reset, a datagram dropped (FEnet EN 6.2.2 (3)).
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/net/own_links.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::plc {

class Ethernet : public net::Host {
 public:
  /// `service` outlives the module. Errors: another one listens on a port of it, or is a server
  /// driver as it is.
  Status add(NetworkService& service);
  bool empty() const { return services_.empty(); }
  /// Links that are there; for tests.
  std::size_t links() const { return owners_.size(); }
  /// Switches the host table on: IPv4 addresses, of which none may be left.
  void allow_only(std::vector<std::string> addresses) { allowed_ = std::move(addresses); }
  /// For services that open links.
  net::OwnLinks& own_links() { return own_links_; }
  /// Packets of the medium since power-on, those that reach no service among them, with which the
  /// lamps TX and RX flicker (tables 2-8, 2-9): "@total_sent", "@total_received", "@udp_sent",
  /// "@udp_received". Nothing: it is none of these names.
  std::optional<std::string> packets(std::string_view name, std::size_t digits) const;
  void forget_packets() { total_ = udp_ = {}; }

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
  /// Datagrams, or what comes or goes at once over a connection.
  struct Packets {
    std::uint32_t sent = 0, received = 0;
  };
  void count(const Burst& burst, std::uint32_t Packets::*way);
  bool is_refused(const Burst& burst) const;
  NetworkService* owner(const Burst& burst);
  void note(const Burst& burst, bool Owner::*closed);

  std::vector<NetworkService*> services_;
  std::map<LinkId, Owner> owners_;  // of the links that are there
  std::optional<std::vector<std::string>> allowed_;
  std::vector<Burst> refusals_;
  net::OwnLinks own_links_;
  Packets total_, udp_;
};

}  // namespace fieldproof::plc
