#include "src/p2p/network_client.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::p2p {

NetworkClient::NetworkClient(std::unique_ptr<P2pClient> client, NetworkPartner partner,
                             net::OwnLinks& links)
    : client_(std::move(client)), partner_(std::move(partner)), links_(links) {
  client_->behind_connection([this] { close(); });
}

void NetworkClient::receive(const Burst& burst) {
  now_ = std::max(now_, burst.start);
  if (by_datagrams()) {
    if (burst.link == link_ && burst.event == LinkEvent::datagram) client_->receive(burst);
    return;
  }
  if (burst.link != link_) return receive_of_old(burst);
  if (burst.event == LinkEvent::data) return client_->receive(burst);
  if (burst.event == LinkEvent::closed) event(link_, LinkEvent::closed);
  link_ = none;
  client_->connection_lost();
}

/// On a connection that was closed, or from before the power went. RST is the answer but to what
/// ends it.
void NetworkClient::receive_of_old(const Burst& burst) {
  const bool over = burst.event == LinkEvent::reset ||
                    (burst.event == LinkEvent::closed && burst.link == half_closed_);
  if (burst.link == half_closed_) half_closed_ = none;
  std::erase(forgotten_, burst.link);
  if (!over) event(burst.link, LinkEvent::reset);
}

std::optional<Time> NetworkClient::wake_at() const {
  return doings_.empty() ? client_->wake_at() : now_;
}

std::vector<Burst> NetworkClient::advance(Time now) {
  now_ = std::max(now_, now);
  if (Bytes request = client_->advance(now_); !request.empty()) send(std::move(request));
  return std::exchange(doings_, {});
}

void NetworkClient::send(Bytes request) {
  if (by_datagrams()) return send_datagram(std::move(request));
  if (link_ == none) {
    end_old();
    client_->connection_opened();
    link_ = links_.next();
    doings_.push_back({.bytes = {},
                       .start = now_,
                       .link = link_,
                       .event = LinkEvent::opened,
                       .port = partner_.port,
                       .peer = partner_.address});
  }
  doings_.push_back({.bytes = std::move(request), .start = now_, .link = link_});
}

void NetworkClient::send_datagram(Bytes request) {
  if (link_ == none) link_ = links_.next();
  doings_.push_back({.bytes = std::move(request),
                     .start = now_,
                     .link = link_,
                     .event = LinkEvent::datagram,
                     .port = partner_.port,
                     .peer = partner_.address});
}

void NetworkClient::close() {
  if (link_ == none || by_datagrams()) return;
  event(link_, LinkEvent::closed);
  half_closed_ = std::exchange(link_, none);
}

void NetworkClient::end_old() {
  if (half_closed_ != none) event(std::exchange(half_closed_, none), LinkEvent::reset);
  for (const LinkId link : std::exchange(forgotten_, {})) event(link, LinkEvent::reset);
}

void NetworkClient::event(LinkId link, LinkEvent what) {
  doings_.push_back({.bytes = {}, .start = now_, .link = link, .event = what});
}

void NetworkClient::power_cycle() {
  client_->power_cycle();
  if (link_ != none && !by_datagrams()) forgotten_.push_back(link_);
  link_ = none;
  doings_.clear();
}

}  // namespace fieldproof::p2p
