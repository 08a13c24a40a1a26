#include "harness/system/sockets/connection.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

namespace {

constexpr std::size_t most_waiting = 8 << 20;

bool is_connected(int fd) {
  sockaddr_storage peer{};
  socklen_t size = sizeof peer;
  return ::getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &size) == 0;
}

}  // namespace

Connection::Connection(UniqueFd fd) : fd_(std::move(fd)) {
  connecting_ = fd_ && !is_connected(fd_.get());
}

Connection::~Connection() {
  if (fd_ && !open_ && !hears_) end_at_once();
}

std::optional<Arrival> Connection::read() {
  if (!hears_) return std::nullopt;
  if (fd_) {
    std::array<Byte, 65'536> buffer;
    ssize_t n = 0;
    do {
      n = ::recv(fd_.get(), buffer.data(), buffer.size(), 0);
    } while (n < 0 && errno == EINTR);
    // Its end, where that follows, is told by poll as well.
    read_all_ = n > 0 && static_cast<std::size_t>(n) < buffer.size();
    if (n > 0) return Arrival{LinkEvent::data, Bytes(buffer.begin(), buffer.begin() + n)};
    if (n < 0 && would_block(errno)) return std::nullopt;
    if (n == 0 && !broken_) {
      hears_ = false;
      end_if_both_closed();
      return Arrival{LinkEvent::closed};
    }
  }
  hears_ = false;
  fd_.reset();
  out_.clear();
  return Arrival{LinkEvent::reset};
}

void Connection::write(ByteView bytes) {
  if (!open_ || !fd_) return;
  out_.insert(out_.end(), bytes.begin(), bytes.end());
  flush();
  if (out_.size() > most_waiting) end_at_once();  // read() tells it
}

void Connection::flush() {
  if (!fd_) return;
  if (connecting_) connecting_ = !is_connected(fd_.get());
  if (connecting_) return;
  while (!out_.empty()) {
    const ssize_t n = ::send(fd_.get(), out_.data(), out_.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && would_block(errno)) return;
    if (n < 0) {
      // Only EPIPE alone may follow a FIN; any other cause is a reset, which `recv` would now show
      // as a FIN.
      broken_ |= errno != EPIPE;
      out_.clear();
      break;
    }
    out_.erase(out_.begin(), out_.begin() + n);
  }
  if (fin_due_) send_fin();
}

void Connection::send_fin() {
  fin_due_ = false;
  fin_sent_ = true;
  ::shutdown(fd_.get(), SHUT_WR);
  end_if_both_closed();
}

void Connection::close(Closing how) {
  open_ = false;
  if (how != Closing::fin) hears_ = false;
  if (!fd_) return;
  if (how == Closing::rst) return end_at_once();
  if (how == Closing::vanish) return out_.clear();
  fin_due_ = true;
  flush();
}

void Connection::end_at_once() {
  const linger none{1, 0};
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_LINGER, &none, sizeof none);
  fd_.reset();
  out_.clear();
}

void Connection::end_if_both_closed() {
  if (!hears_ && fin_sent_) fd_.reset();
}

pollfd Connection::to_poll(bool hearing) const {
  short events = hears_ && hearing && !is_full() ? POLLIN : 0;
  if (connecting_ || has_waiting()) events |= POLLOUT;
  return {events == 0 ? -1 : fd_.get(), events, 0};
}

}  // namespace fieldproof::os
