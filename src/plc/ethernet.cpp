#include "src/plc/ethernet.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::plc {

bool Ethernet::listens(Transport transport, std::uint16_t port) const {
  return std::ranges::any_of(
      services_, [&](const NetworkService* service) { return service->listens(transport, port); });
}

NetworkService* Ethernet::owner(const Burst& burst) {
  if (const auto known = owners_.find(burst.link); known != owners_.end()) return known->second;
  const Transport transport = burst.event == LinkEvent::datagram ? Transport::udp : Transport::tcp;
  const auto found = std::ranges::find_if(services_, [&](const NetworkService* service) {
    return service->listens(transport, burst.port);
  });
  return found == services_.end() ? nullptr : owners_[burst.link] = *found;
}

void Ethernet::receive(const Burst& burst) {
  NetworkService* const service = owner(burst);
  if (burst.event == LinkEvent::reset) owners_.erase(burst.link);
  if (service) service->receive(burst);
}

std::optional<Time> Ethernet::wake_at() const {
  std::optional<Time> first;
  for (const NetworkService* service : services_)
    if (const std::optional<Time> wake = service->wake_at(); wake && (!first || *wake < *first))
      first = wake;
  return first;
}

std::vector<Burst> Ethernet::advance(Time now) {
  std::vector<Burst> all;
  for (NetworkService* service : services_) {
    for (Burst& burst : service->advance(now)) {
      if (burst.link >= first_own_link) owners_[burst.link] = service;
      all.push_back(std::move(burst));
    }
  }
  return all;
}

}  // namespace fieldproof::plc
