#include "src/p2p/network_client.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::p2p {

NetworkClient::NetworkClient(std::unique_ptr<P2pClient> client, NetworkPartner partner,
                             net::OwnLinks& links)
    : client_(std::move(client)), partner_(std::move(partner)), links_(links) {
  client_->on_time_out([this] { close(); });
}

void NetworkClient::receive(const Burst& burst) {
  now_ = std::max(now_, burst.start);
  if (burst.link != link_) {
    // A connection from before the power went, or one that was closed.
    if (burst.event == LinkEvent::data) event(burst.link, LinkEvent::reset);
    return;
  }
  if (burst.event == LinkEvent::data) return client_->receive(burst);
  if (burst.event == LinkEvent::closed)
    close();
  else
    link_ = none;
  client_->connection_lost();
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
  if (link_ == none) {
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

void NetworkClient::close() {
  if (link_ != none) event(std::exchange(link_, none), LinkEvent::closed);
}

void NetworkClient::event(LinkId link, LinkEvent what) {
  doings_.push_back({.bytes = {}, .start = now_, .link = link, .event = what});
}

void NetworkClient::power_cycle() {
  client_->power_cycle();
  link_ = none;
  doings_.clear();
}

}  // namespace fieldproof::p2p
