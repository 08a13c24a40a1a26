// A P2P channel of the Ethernet module (FEnet EN 7.1.1, 7.3.2): the client of client.hpp behind a
// connection to one partner.
//
// The connection is opened at the first request, kept, and opened again at the next request after
// it was lost or a reply has not come in time. What is under way when it is lost, or refused, ends
// with STATUS 07 (Cnet EN Appendix 3.3: it could not be sent); the manual prints no code
// (decision). After a time-out the client closes with FIN: a reply that comes late belongs to no
// request. Where the stream cannot be followed any more the connection ends, too. What is left of
// an old connection, closed by the client alone or forgotten when the power went, ends by RST
// before the next one is opened.
//
// Over UDP requests are datagrams of one port of its own, which is another one when the power went;
// there is nothing to open or to lose, and whether anybody listens is not heard.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "src/net/own_links.hpp"
#include "src/p2p/client.hpp"
#include "src/plc/service.hpp"

namespace fieldproof::p2p {

/// Whom the channel asks; an empty address is left to whoever carries the connection.
struct NetworkPartner {
  std::string address{};
  std::uint16_t port = 0;
  Transport transport = Transport::tcp;
};

class NetworkClient : public plc::NetworkService {
 public:
  /// `links` outlives the client.
  NetworkClient(std::unique_ptr<P2pClient> client, NetworkPartner partner, net::OwnLinks& links);

  std::vector<Port> ports() const override { return {}; }
  void receive(const Burst& burst) override;
  std::optional<Time> wake_at() const override;
  std::vector<Burst> advance(Time now) override;

  const plc::ServiceCounters& counters() const override { return client_->counters(); }
  /// The connection is gone without a word.
  void power_cycle() override;
  void set_run(bool run) override { client_->set_run(run); }
  void scan() override { client_->scan(); }
  std::vector<std::string> actions() const override { return client_->actions(); }
  std::optional<Status> act(std::string_view action) override { return client_->act(action); }

 private:
  static constexpr LinkId none = 0;

  bool by_datagrams() const { return partner_.transport == Transport::udp; }
  void send(Bytes request);
  void send_datagram(Bytes request);
  void close();
  void receive_of_old(const Burst& burst);
  void end_old();
  void event(LinkId link, LinkEvent what);

  std::unique_ptr<P2pClient> client_;
  NetworkPartner partner_;
  net::OwnLinks& links_;
  LinkId link_ = none;
  LinkId half_closed_ = none;      // by this client; its partner may still send
  std::vector<LinkId> forgotten_;  // when the power went
  std::vector<Burst> doings_;
  Time now_{};
};

}  // namespace fieldproof::p2p
