// A datagram port that others send to: each of them is a link.
#pragma once

#include <functional>
#include <map>

#include "harness/system/sockets/socket_address.hpp"
#include "harness/system/unique_fd.hpp"
#include "src/base/burst.hpp"

namespace fieldproof::os {

class DatagramServer {
 public:
  /// Takes over a non-blocking socket that is bound; `port` is what bursts call it.
  DatagramServer(UniqueFd fd, std::uint16_t port) : fd_(std::move(fd)), port_(port) {}

  int fd() const { return fd_.get(); }
  /// The next datagram, on the link of its sender; a new sender becomes the link that `new_link`
  /// gives. Senders are many (a port scan): of those that were silent longest the links are
  /// forgotten.
  std::optional<Burst> read(const std::function<LinkId()>& new_link);
  bool has(LinkId link) const { return peers_.contains(link); }
  /// One datagram to the sender that `link` is; lost where the socket does not take it.
  void write(ByteView bytes, LinkId link);

 private:
  struct Peer {
    SocketAddress address;
    std::uint64_t heard = 0;  // number of its last datagram
  };
  LinkId link_of(const SocketAddress& from, const std::function<LinkId()>& new_link);

  UniqueFd fd_;
  std::uint16_t port_;
  std::map<LinkId, Peer> peers_;
  std::map<std::string, LinkId> links_;  // by address
  std::uint64_t count_ = 0;
};

}  // namespace fieldproof::os
