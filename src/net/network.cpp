#include "src/net/network.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace fieldproof::net {

namespace {
/// A host that asks this often at one moment never stops: a fault in the host.
constexpr int most_wakes_at_one_moment = 10'000;
/// As on loopback, so that host tables mean the same there; ports are ephemeral ones.
constexpr std::string_view bench_address = "127.0.0.1";
constexpr unsigned first_bench_port = 49152, bench_ports = 16384;

std::string bench_peer(LinkId link) {
  return fmt::format("{}:{}", bench_address, first_bench_port + link % bench_ports);
}

Burst event_on(LinkId link, LinkEvent event, std::uint16_t port = 0, std::string peer = {}) {
  return {.bytes = {}, .link = link, .event = event, .port = port, .peer = std::move(peer)};
}
}  // namespace

SimulatedNetwork::SimulatedNetwork(const Conditions& conditions, Time now, LinkId first_link)
    : conditions_(conditions), chance_(conditions.seed), now_(now), next_link_(first_link) {}

void SimulatedNetwork::attach(Host& host) {
  if (host_) throw std::logic_error("a simulated network has one host");
  host_ = &host;
  for (Burst& burst : host.advance(now_)) host_does(std::move(burst));
}

LinkId SimulatedNetwork::open(Transport transport, std::uint16_t port) {
  const LinkId id = new_link();
  Link& link = links_[id];
  link.transport = transport;
  link.port = port;
  link.peer = bench_peer(id);
  if (transport == Transport::tcp) {
    fly(true, link, event_on(id, LinkEvent::opened, port, link.peer));
    run_now();
  }
  return id;
}

Status SimulatedNetwork::close(LinkId id, Closing how) {
  const auto found = links_.find(id);
  if (found == links_.end() || !found->second.bench_sends)
    return fail(fmt::format("cannot close link {}: it is not open", id));
  Link& link = found->second;
  link.bench_sends = false;
  if (how != Closing::fin || link.transport == Transport::udp) {
    link.bench_hears = false;
    std::erase_if(inbox_, [id](const Burst& burst) { return burst.link == id; });
  }
  if (how != Closing::vanish && link.transport == Transport::tcp)
    fly(true, link, event_on(id, how == Closing::fin ? LinkEvent::closed : LinkEvent::reset));
  run_now();
  return ok();
}

Result<Sent> SimulatedNetwork::send(LinkId id, ByteView bytes) {
  const auto found = links_.find(id);
  if (found == links_.end() || !found->second.bench_sends)
    return fail(fmt::format("cannot send on link {}: it is not open", id));
  const std::optional<Time> wake = run(now_, false, host_wake());
  Link& link = found->second;
  Burst burst{.bytes = Bytes(bytes.begin(), bytes.end()), .link = id};
  if (link.transport == Transport::udp) {
    burst.event = LinkEvent::datagram;
    burst.port = link.port;
    burst.peer = link.peer;
  }
  dispatch(true, link, std::move(burst));
  run(now_, false, wake);
  return Sent{now_, now_};
}

Burst SimulatedNetwork::receive(Time until) {
  if (inbox_.empty()) run(std::max(until, now_));
  if (std::optional<Burst> burst = take()) return std::move(*burst);
  return {.bytes = {}, .start = now_};
}

std::optional<Burst> SimulatedNetwork::take() {
  if (inbox_.empty()) return std::nullopt;
  Burst burst = std::move(inbox_.front());
  inbox_.pop_front();
  return burst;
}

std::optional<Time> SimulatedNetwork::next_event() const { return next_event(host_wake()); }

std::optional<Time> SimulatedNetwork::next_event(std::optional<Time> wake) const {
  std::optional<Time> next = wake;
  if (!flights_.empty())
    next = next ? std::min(*next, flights_.begin()->first) : flights_.begin()->first;
  if (next) next = std::max(*next, now_);
  return next;
}

std::optional<Time> SimulatedNetwork::run(Time until, bool until_heard, std::optional<Time> wake) {
  for (;;) {
    const std::optional<Time> next = next_event(wake);
    if (!next || *next > until) break;
    now_ = *next;
    const bool told = deliver_due();
    if (until_heard && !inbox_.empty()) return wake;
    if (told || (wake && *wake <= now_)) wake = wake_host();
  }
  now_ = std::max(now_, until);
  return wake;
}

bool SimulatedNetwork::deliver_due() {
  bool told = false;
  while (!flights_.empty() && flights_.begin()->first <= now_) {
    Flight flight = std::move(flights_.begin()->second);
    flights_.erase(flights_.begin());
    join_following(flight);
    flight.burst.start = now_;
    told |= flight.to_host;
    if (flight.to_host)
      deliver_to_host(flight.burst);
    else
      deliver_to_bench(std::move(flight.burst));
  }
  return told;
}

/// Bytes of the same link that are due now, too, as far as chance joins them.
void SimulatedNetwork::join_following(Flight& flight) {
  if (flight.burst.event != LinkEvent::data) return;
  while (!flights_.empty() && flights_.begin()->first <= now_) {
    Flight& next = flights_.begin()->second;
    const bool same = next.to_host == flight.to_host && next.burst.link == flight.burst.link &&
                      next.burst.event == LinkEvent::data;
    if (!same || !chance_.happens(conditions_.join)) return;
    flight.burst.bytes.insert(flight.burst.bytes.end(), next.burst.bytes.begin(),
                              next.burst.bytes.end());
    flights_.erase(flights_.begin());
  }
}

void SimulatedNetwork::deliver_to_host(const Burst& burst) {
  Link& link = links_.at(burst.link);
  if (!link.stands || !host_) return;
  const bool begins = burst.event == LinkEvent::opened || burst.event == LinkEvent::datagram;
  if (begins && burst.link < first_own_link && !host_->listens(link.transport, burst.port)) {
    if (burst.event != LinkEvent::opened) return;
    link.stands = false;
    return fly(false, link, event_on(burst.link, LinkEvent::reset));
  }
  if (burst.event == LinkEvent::reset) link.stands = false;
  host_->receive(burst);
}

void SimulatedNetwork::deliver_to_bench(Burst&& burst) {
  Link& link = links_.at(burst.link);
  if (!link.bench_hears) return;
  if (burst.event == LinkEvent::opened && !takes_connections_) {
    link.bench_sends = link.bench_hears = false;
    return fly(true, link, event_on(burst.link, LinkEvent::reset));
  }
  if (burst.event == LinkEvent::reset) link.bench_hears = false;
  inbox_.push_back(std::move(burst));
}

std::optional<Time> SimulatedNetwork::wake_host() {
  if (!host_) return std::nullopt;
  for (int wakes = 0;; ++wakes) {
    const std::optional<Time> wake = host_->wake_at();
    if (!wake || *wake > now_) return wake;
    if (wakes == most_wakes_at_one_moment) {
      throw std::logic_error(
          fmt::format("the host asks to be woken at {} ns without end; its advance must move "
                      "wake_at on",
                      now_.count()));
    }
    for (Burst& burst : host_->advance(now_)) host_does(std::move(burst));
  }
}

void SimulatedNetwork::host_does(Burst&& burst) {
  const bool own = burst.link >= first_own_link;
  const auto found = links_.find(burst.link);
  if (found == links_.end()) {
    if (!own || (burst.event != LinkEvent::opened && burst.event != LinkEvent::datagram))
      throw std::logic_error(fmt::format("the host uses link {}, which never was", burst.link));
    return host_connects(std::move(burst));
  }
  if (burst.event == LinkEvent::opened)
    throw std::logic_error(fmt::format("the host opens link {} twice", burst.link));
  Link& link = found->second;
  if (!link.stands) return;
  if (burst.event == LinkEvent::reset) link.stands = false;
  const bool sends = burst.event == LinkEvent::data || burst.event == LinkEvent::closed;
  if (sends && !link.host_sends) return;
  if (burst.event == LinkEvent::closed) link.host_sends = false;
  if (burst.event == LinkEvent::datagram) burst.port = link.port;
  dispatch(false, link, std::move(burst));
}

void SimulatedNetwork::host_connects(Burst&& burst) {
  Link& link = links_[burst.link];
  link.transport = burst.event == LinkEvent::opened ? Transport::tcp : Transport::udp;
  link.port = burst.port;
  link.peer = burst.peer;
  dispatch(false, link, std::move(burst));
}

/// Cuts a segment into the pieces in which it travels.
void SimulatedNetwork::dispatch(bool to_host, Link& link, Burst&& burst) {
  if (burst.event == LinkEvent::datagram) return send_datagram(to_host, burst);
  if (burst.event != LinkEvent::data || conditions_.cut == 0)
    return fly(to_host, link, std::move(burst));
  Bytes piece;
  for (const Byte b : burst.bytes) {
    piece.push_back(b);
    if (chance_.happens(conditions_.cut))
      fly(to_host, link, {.bytes = std::exchange(piece, {}), .link = burst.link});
  }
  if (!piece.empty()) fly(to_host, link, {.bytes = std::move(piece), .link = burst.link});
}

void SimulatedNetwork::fly(bool to_host, Link& link, Burst&& burst) {
  Time& last = to_host ? link.to_host : link.to_bench;
  last = std::max(last, now_ + travel());
  flights_.emplace(last, Flight{to_host, std::move(burst)});
}

void SimulatedNetwork::send_datagram(bool to_host, const Burst& burst) {
  if (chance_.happens(conditions_.lost)) return;
  const bool doubled = chance_.happens(conditions_.doubled);
  for (int copies = doubled ? 2 : 1; copies > 0; --copies) {
    const bool late = chance_.happens(conditions_.late);
    const Time arrival = now_ + travel() + (late ? conditions_.lateness : Duration::zero());
    flights_.emplace(arrival, Flight{to_host, burst});
  }
}

}  // namespace fieldproof::net
