#include "src/plc/ethernet.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace fieldproof::plc {

bool Ethernet::listens(Transport transport, std::uint16_t port) const {
  return std::ranges::any_of(
      services_, [&](const NetworkService* service) { return service->listens(transport, port); });
}

Status Ethernet::add(NetworkService& service) {
  for (const NetworkService::Port& port : service.ports())
    if (listens(port.transport, port.number))
      return fail(fmt::format("cannot put two services on {} port {}; leave one of them out",
                              port.transport == Transport::tcp ? "TCP" : "UDP", port.number));
  if (service.is_driver() && std::ranges::any_of(services_, &NetworkService::is_driver))
    return fail(
        "cannot put two server drivers on one Ethernet module; leave the XGT or the Modbus TCP "
        "server out");
  services_.push_back(&service);
  return ok();
}

/// Does it come from an address that the host table does not have?
bool Ethernet::is_refused(const Burst& burst) const {
  if (!allowed_ || owners_.contains(burst.link) || burst.link >= first_own_link) return false;
  const std::string address = burst.peer.substr(0, burst.peer.rfind(':'));
  return std::ranges::find(*allowed_, address) == allowed_->end();
}

NetworkService* Ethernet::owner(const Burst& burst) {
  if (const auto known = owners_.find(burst.link); known != owners_.end())
    return known->second.service;
  const Transport transport = burst.event == LinkEvent::datagram ? Transport::udp : Transport::tcp;
  const auto found = std::ranges::find_if(services_, [&](const NetworkService* service) {
    return service->listens(transport, burst.port);
  });
  if (found == services_.end()) return nullptr;
  owners_[burst.link].service = *found;
  return *found;
}

/// What a burst in one direction, whose FIN `closed` remembers, does to its link.
void Ethernet::note(const Burst& burst, bool Owner::*closed) {
  const auto known = owners_.find(burst.link);
  if (known == owners_.end()) return;
  if (burst.event == LinkEvent::closed) known->second.*closed = true;
  const bool both = known->second.closed_by_client && known->second.closed_by_us;
  if (both || burst.event == LinkEvent::reset) owners_.erase(known);
}

void Ethernet::count(const Burst& burst, std::uint32_t Packets::*way) {
  if (burst.event == LinkEvent::datagram) ++(udp_.*way);
  if (burst.event == LinkEvent::datagram || burst.event == LinkEvent::data) ++(total_.*way);
}

std::optional<std::string> Ethernet::packets(std::string_view name, std::size_t digits) const {
  if (name == "@total_sent") return counter_text(total_.sent, digits);
  if (name == "@total_received") return counter_text(total_.received, digits);
  if (name == "@udp_sent") return counter_text(udp_.sent, digits);
  if (name == "@udp_received") return counter_text(udp_.received, digits);
  return std::nullopt;
}

void Ethernet::receive(const Burst& burst) {
  count(burst, &Packets::received);
  if (is_refused(burst)) {
    if (burst.event == LinkEvent::opened)
      refusals_.push_back(
          {.bytes = {}, .start = burst.start, .link = burst.link, .event = LinkEvent::reset});
    return;
  }
  NetworkService* const service = owner(burst);
  note(burst, &Owner::closed_by_client);
  if (service) service->receive(burst);
}

std::optional<Time> Ethernet::wake_at() const {
  std::optional<Time> first;
  if (!refusals_.empty()) first = refusals_.front().start;
  for (const NetworkService* service : services_)
    if (const std::optional<Time> wake = service->wake_at(); wake && (!first || *wake < *first))
      first = wake;
  return first;
}

std::vector<Burst> Ethernet::advance(Time now) {
  std::vector<Burst> all = std::exchange(refusals_, {});
  for (NetworkService* service : services_) {
    for (Burst& burst : service->advance(now)) {
      const bool ends = burst.event == LinkEvent::closed || burst.event == LinkEvent::reset;
      if (burst.link >= first_own_link && !ends) owners_[burst.link].service = service;
      note(burst, &Owner::closed_by_us);
      count(burst, &Packets::sent);
      all.push_back(std::move(burst));
    }
  }
  return all;
}

}  // namespace fieldproof::plc
