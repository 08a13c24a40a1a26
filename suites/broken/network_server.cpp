#include "suites/broken/network_server.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::broken {

void NetworkServer::receive(const Burst& burst) {
  now_ = burst.start;
  if (!behaviour_.hear) return take(burst);
  for (const Burst& heard : behaviour_.hear(burst, server_)) take(heard);
}

std::optional<Time> NetworkServer::wake_at() const {
  return does_.empty() ? good_->network()->wake_at() : std::optional(now_);
}

std::vector<Burst> NetworkServer::advance(Time now) {
  now_ = now;
  collect();
  if (behaviour_.act) behaviour_.act(does_, server_);
  return std::exchange(does_, {});
}

void NetworkServer::take(const Burst& heard) {
  if (heard.event == LinkEvent::data) return take_bytes(heard);
  if (heard.event == LinkEvent::datagram) return ask(heard, heard.bytes);
  streams_.erase(heard.link);
  if (heard.event == LinkEvent::opened)
    server_.links.push_back(heard.link);
  else
    std::erase(server_.links, heard.link);
  good_->network()->receive(heard);
  collect();
}

void NetworkServer::take_bytes(const Burst& heard) {
  Bytes& stream = streams_[heard.link];
  stream.insert(stream.end(), heard.bytes.begin(), heard.bytes.end());
  while (const std::optional<Bytes> request = next_request(heard.link)) ask(heard, *request);
}

/// Taken from the stream of the link, which may be gone: a request may make the server reset it.
std::optional<Bytes> NetworkServer::next_request(LinkId link) {
  const auto found = streams_.find(link);
  if (found == streams_.end()) return std::nullopt;
  Bytes& stream = found->second;
  const std::optional<std::size_t> size = first_frame_(stream);
  if (!size) return std::nullopt;
  const auto end = stream.begin() + static_cast<std::ptrdiff_t>(*size);
  const Bytes request(stream.begin(), end);
  stream.erase(stream.begin(), end);
  return request;
}

void NetworkServer::ask(const Burst& heard, const Bytes& request) {
  Burst understood = heard;
  understood.bytes = behaviour_.misread ? behaviour_.misread(request) : request;
  if (understood.bytes.empty()) return;
  const std::size_t before = does_.size();
  good_->network()->receive(understood);
  collect();
  for (std::size_t i = before; behaviour_.edit && i < does_.size(); ++i)
    if (does_[i].event == LinkEvent::data || does_[i].event == LinkEvent::datagram)
      behaviour_.edit(does_[i].bytes, request);
}

void NetworkServer::collect() {
  for (Burst& burst : good_->network()->advance(now_)) {
    if (burst.event == LinkEvent::reset) {
      std::erase(server_.links, burst.link);
      streams_.erase(burst.link);
    }
    does_.push_back(std::move(burst));
  }
}

}  // namespace fieldproof::broken
