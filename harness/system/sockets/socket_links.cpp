#include "harness/system/sockets/socket_links.hpp"

#include <algorithm>
#include <utility>

#include "harness/system/sockets/socket_listen.hpp"

namespace fieldproof::os {

namespace {

/// So many connections that are over are remembered, the last ones.
constexpr std::size_t most_remembered = 200;
/// Descriptors run out at about a thousand: further connections wait until one ends.
constexpr std::size_t most_connections = 900;

constexpr const char* closed_here = "the link is not open: it was closed on this side";

Burst on(LinkId link, Arrival arrival) {
  Burst burst;
  burst.link = link;
  burst.event = arrival.event;
  burst.bytes = std::move(arrival.bytes);
  return burst;
}

}  // namespace

void SocketLinks::add(LinkId link, Connection connection) {
  put_aside();
  connections_.insert_or_assign(link, Link{std::move(connection)});
}

void SocketLinks::add(LinkId link, DatagramPort port) {
  ports_.insert_or_assign(link, Port{std::move(port)});
}

bool SocketLinks::stands(LinkId link) const {
  const auto found = connections_.find(link);
  return found == connections_.end() ? !over_.contains(link) && !lost_.contains(link)
                                     : found->second.connection.stands();
}

void SocketLinks::listen(UniqueFd socket, Transport transport, std::uint16_t port) {
  if (transport == Transport::tcp)
    listeners_.push_back({std::move(socket), port});
  else
    servers_.push_back({DatagramServer(std::move(socket), port)});
}

std::optional<Burst> SocketLinks::take() {
  // A client that ends one connection and opens another has ended it by the time the other is
  // accepted: so that is heard first, and a device with few places has one free.
  if (accepted_.empty()) {
    if (std::optional<Burst> heard = take_of_links()) return heard;
    accept_waiting();
    if (accepted_.empty()) return std::nullopt;
    look_at_all_connections();
  }
  if (std::optional<Burst> heard = take_of_links()) return heard;
  if (accepted_.empty()) return std::nullopt;
  Burst opened = std::move(accepted_.front());
  accepted_.pop_front();
  return opened;
}

std::optional<Burst> SocketLinks::take_of_links() {
  // Each in turn: one that floods does not silence the others.
  auto next = connections_.upper_bound(last_);
  for (std::size_t i = 0; i < connections_.size(); ++i, ++next) {
    if (next == connections_.end()) next = connections_.begin();
    Link& link = next->second;
    if (is_untold(next->first) || link.connection.is_full()) continue;
    if (!link.ready && !link.connection.has_broken()) continue;
    std::optional<Arrival> arrival = link.connection.read();
    link.ready = arrival && !link.connection.has_read_all();
    if (!arrival) continue;
    Burst burst = on(last_ = next->first, std::move(*arrival));
    burst.port = link.port;
    burst.peer = link.peer;
    return burst;
  }
  return take_of_datagrams();
}

std::optional<Burst> SocketLinks::take_of_datagrams() {
  for (auto& [link, one] : ports_) {
    if (!one.ready) continue;
    if (std::optional<Arrival> arrival = one.port.read()) return on(link, std::move(*arrival));
    one.ready = false;
  }
  for (Server& one : servers_) {
    if (!one.ready) continue;
    if (std::optional<Burst> burst = one.server.read([this] { return next_link_++; })) return burst;
    one.ready = false;
  }
  return std::nullopt;
}

/// What has come since the last answer of poll, too.
void SocketLinks::look_at_all_connections() {
  for (auto& [id, link] : connections_) link.ready = true;
}

bool SocketLinks::is_untold(LinkId link) const {
  return std::ranges::any_of(accepted_, [link](const Burst& one) { return one.link == link; });
}

void SocketLinks::accept_waiting() {
  put_aside();
  for (Listener& listener : listeners_) {
    SocketAddress from;
    while (listener.ready && has_room()) {
      UniqueFd fd = accept_socket(listener.fd.get(), from);
      listener.ready = bool(fd);
      if (!fd) break;
      Burst opened;
      opened.link = next_link_++;
      opened.event = LinkEvent::opened;
      opened.port = listener.port;
      opened.peer = to_string(from);
      accepted_.push_back(opened);
      connections_.emplace(opened.link, Link{Connection(std::move(fd)), opened.port, opened.peer});
    }
  }
}

Status SocketLinks::send(LinkId link, ByteView bytes) {
  if (lost_.erase(link) != 0) add(link, Connection(UniqueFd()));
  if (const auto found = connections_.find(link); found != connections_.end()) {
    if (!found->second.connection.is_open()) return fail(closed_here);
    found->second.connection.write(bytes);
    return ok();
  }
  if (const auto found = over_.find(link); found != over_.end())
    return found->second ? ok() : fail(closed_here);
  if (const auto found = ports_.find(link); found != ports_.end() && found->second.port.is_open())
    return found->second.port.write(bytes);
  for (Server& one : servers_) {
    if (!one.server.has(link)) continue;
    one.server.write(bytes, link);
    return ok();
  }
  return fail("the link is not open");
}

Status SocketLinks::close(LinkId link, Closing how) {
  if (lost_.erase(link) != 0) return ok();
  if (const auto found = connections_.find(link); found != connections_.end()) {
    if (!found->second.connection.is_open()) return fail(closed_here);
    found->second.connection.close(how);
    return ok();
  }
  if (const auto found = over_.find(link); found != over_.end())
    return std::exchange(found->second, false) ? ok() : fail(closed_here);
  if (const auto found = ports_.find(link); found != ports_.end() && found->second.port.is_open()) {
    found->second.port.close();
    return ok();
  }
  return fail("the link is not open");
}

bool SocketLinks::flush(LinkId link) {
  const auto found = connections_.find(link);
  if (found == connections_.end()) return false;
  found->second.connection.flush();
  return found->second.connection.has_waiting();
}

void SocketLinks::flush() {
  for (auto& [id, link] : connections_) link.connection.flush();
}

void SocketLinks::end_all() {
  connections_.clear();
  over_.clear();
  ports_.clear();
  lost_.clear();
  accepted_.clear();
  SocketAddress from;
  for (const Listener& listener : listeners_)
    while (accept_socket(listener.fd.get(), from)) {
    }
}

void SocketLinks::lose_all() {
  std::set<LinkId> lost;
  for (const auto& [link, one] : connections_)
    if (one.connection.is_open()) lost.insert(link);
  for (const auto& [link, open] : over_)
    if (open) lost.insert(link);
  end_all();
  lost_ = std::move(lost);
}

void SocketLinks::end_closed() {
  std::erase_if(connections_, [](const auto& one) { return !one.second.connection.is_open(); });
  std::erase_if(over_, [](const auto& one) { return !one.second; });
}

void SocketLinks::add_to(std::vector<pollfd>& fds, bool hearing) const {
  for (const auto& [id, link] : connections_) fds.push_back(link.connection.to_poll(hearing));
  if (!hearing) return;
  for (const auto& [link, one] : ports_) fds.push_back(one.port.to_poll());
  for (const Listener& listener : listeners_)
    fds.push_back({has_room() ? listener.fd.get() : -1, POLLIN, 0});
  for (const Server& one : servers_) fds.push_back({one.server.fd(), POLLIN, 0});
}

void SocketLinks::heard(std::span<const pollfd> answers) {
  auto answer = answers.begin();
  const auto take_answer = [&](bool& ready) { ready |= (answer++)->revents != 0; };
  for (auto& [id, link] : connections_) take_answer(link.ready);
  for (auto& [id, one] : ports_) take_answer(one.ready);
  for (Listener& listener : listeners_) take_answer(listener.ready);
  for (Server& one : servers_) take_answer(one.ready);
}

bool SocketLinks::has_room() const { return connections_.size() < most_connections; }

void SocketLinks::put_aside() {
  std::erase_if(connections_, [this](const auto& one) {
    const Connection& connection = one.second.connection;
    if (connection.is_over()) over_[one.first] = connection.is_open();
    return connection.is_over();
  });
  while (over_.size() > most_remembered) over_.erase(over_.begin());
}

}  // namespace fieldproof::os
