#include "harness/system/sockets/datagram_server.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

namespace fieldproof::os {

namespace {

constexpr std::size_t most_peers = 1000;

}  // namespace

std::optional<Burst> DatagramServer::read(const std::function<LinkId()>& new_link) {
  std::array<Byte, 65'536> buffer;
  SocketAddress from;
  ssize_t n = 0;
  do {
    n = ::recvfrom(fd_.get(), buffer.data(), buffer.size(), 0, from.get(), &from.size);
  } while (n < 0 && errno == EINTR);
  if (n < 0) return std::nullopt;
  Burst burst;
  burst.bytes.assign(buffer.begin(), buffer.begin() + n);
  burst.event = LinkEvent::datagram;
  burst.link = link_of(from, new_link);
  burst.port = port_;
  burst.peer = to_string(from);
  return burst;
}

LinkId DatagramServer::link_of(const SocketAddress& from, const std::function<LinkId()>& new_link) {
  const std::string name = to_string(from);
  auto found = links_.find(name);
  if (found == links_.end()) {
    if (peers_.size() >= most_peers) {
      const auto oldest =
          std::ranges::min_element(peers_, {}, [](const auto& peer) { return peer.second.heard; });
      links_.erase(to_string(oldest->second.address));
      peers_.erase(oldest);
    }
    found = links_.emplace(name, new_link()).first;
    peers_[found->second].address = from;
  }
  peers_[found->second].heard = ++count_;
  return found->second;
}

void DatagramServer::write(ByteView bytes, LinkId link) {
  const SocketAddress& to = peers_.at(link).address;
  while (::sendto(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL, to.get(), to.size) < 0 &&
         errno == EINTR) {
  }
}

}  // namespace fieldproof::os
