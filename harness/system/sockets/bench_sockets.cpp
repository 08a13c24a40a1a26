#include "harness/system/sockets/bench_sockets.hpp"

#include <time.h>

#include <algorithm>

#include "harness/system/interrupt.hpp"

namespace fieldproof::os {

namespace {

std::string peer_of(int fd) {
  SocketAddress address;
  return ::getpeername(fd, address.get(), &address.size) == 0 ? to_string(address) : "";
}

}  // namespace

LinkId BenchSockets::add(Transport transport, UniqueFd socket, std::uint16_t port) {
  const LinkId link = next_link_++;
  if (transport == Transport::tcp) {
    links_.add(link, Connection(std::move(socket)));
  } else {
    targets_[link] = {port, peer_of(socket.get())};
    links_.add(link, DatagramPort(std::move(socket)));
  }
  return link;
}

Status BenchSockets::close(LinkId link, Closing how) {
  const Status closed = links_.close(link, how);
  return closed ? ok() : fail("cannot close a link of " + name_ + ": " + closed.error().message);
}

Result<Sent> BenchSockets::send(ByteView bytes, LinkId link) {
  if (interrupted()) return interrupted_error("send to", name_);
  if (far_end_ && far_end_->ended()) return ended("send to");
  Sent sent;
  sent.start = now();
  if (const Status taken = links_.send(link, bytes); !taken)
    return fail("cannot send to " + name_ + ": " + taken.error().message);
  while (links_.flush(link)) {
    const Result<bool> ready = wait(sent.start + send_limit_, false);
    if (!ready) return ready.error();
    if (!*ready)
      return fail("cannot send to " + name_ +
                  ": the far end takes no more bytes; see that it reads");
  }
  sent.end = now();
  return sent;
}

Result<Burst> BenchSockets::receive(Time deadline) {
  for (bool over = false, late = false;;) {
    if (interrupted()) return interrupted_error("receive from", name_);
    if (std::optional<Burst> heard = links_.take()) return stamped(std::move(*heard));
    if (over) return ended("receive from");
    if (late) return stamped({});
    // Before the last look: what a process did before its end is then there to be taken.
    over = far_end_ && far_end_->ended();
    late = now() >= deadline;
    const Result<bool> ready = wait(over ? Time{} : deadline, true);
    if (!ready) return ready.error();
  }
}

/// Until something may have happened; false: `deadline` has passed.
Result<bool> BenchSockets::wait(Time deadline, bool hearing) {
  fds_.assign({{interrupt_fd(), POLLIN, 0}, {far_end_ ? far_end_->end_fd() : -1, POLLIN, 0}});
  constexpr std::size_t before_links = 2;
  links_.add_to(fds_, hearing);
  const Duration left = std::max(deadline - now(), Duration::zero());
  const timespec timeout{static_cast<time_t>(left / 1s), static_cast<long>((left % 1s).count())};
  const int ready = ::ppoll(fds_.data(), fds_.size(), &timeout, nullptr);
  if (interrupted()) return interrupted_error("wait for", name_);
  if (ready > 0 && hearing) links_.heard(std::span(fds_).subspan(before_links));
  return ready != 0;
}

Error BenchSockets::ended(const char* verb) {
  return fail("cannot " + std::string(verb) + ' ' + name_ + ": " + far_end_->how());
}

Burst BenchSockets::stamped(Burst burst) const {
  burst.start = now();
  const auto target = targets_.find(burst.link);
  if (target == targets_.end()) return burst;
  burst.port = target->second.port;
  burst.peer = target->second.peer;
  return burst;
}

}  // namespace fieldproof::os
