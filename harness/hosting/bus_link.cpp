#include "harness/hosting/bus_link.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "harness/hosting/listening.hpp"
#include "harness/system/sockets/socket_connect.hpp"

namespace fieldproof::hosting {

namespace {
/// No line of a sound partner is as long.
constexpr std::size_t longest_line = 100'000;
}  // namespace

Result<BusLink> BusLink::open(const std::string& address) {
  const Result<os::SocketName> name = read_address(address, std::nullopt);
  if (!name) return name.error();
  BusLink link;
  link.address_ = to_string(*name);
  link.description_ = "bus " + link.address_;
  if (const Status met = link.meet(); !met) return met.error();
  return link;
}

/// Both may come at once: then one of them listens when the other tries again.
Status BusLink::meet() {
  greeted_ = false;
  heard_.clear();
  for (int attempt = 0;; ++attempt) {
    if (Result<os::UniqueFd> other = os::connect_socket(address_, SOCK_STREAM)) {
      joined_ = std::move(*other);
      return ok();
    }
    Result<Listening> listening = listen_on(address_, Transport::tcp, std::nullopt);
    if (listening) {
      waiting_ = std::move(listening->socket);
      return ok();
    }
    if (attempt == 1) return fail("--bus: " + listening.error().message);
  }
}

void BusLink::add_to(std::vector<pollfd>& fds) const {
  fds.push_back({joined_ ? joined_.get() : waiting_.get(), POLLIN, 0});
}

Status BusLink::serve(plc::BusEnd& end) {
  if (!joined_) {
    os::SocketAddress from;
    joined_ = os::accept_socket(waiting_.get(), from);
    if (!joined_) return ok();
  }
  if (!greeted_) greet(end);
  std::array<char, 4096> buffer;
  ssize_t count = 0;
  while ((count = ::recv(joined_.get(), buffer.data(), buffer.size(), MSG_DONTWAIT)) > 0) {
    heard_.append(buffer.data(), static_cast<std::size_t>(count));
    if (const Status heard = hear_lines(end); !heard) {
      joined_.reset();
      end.part();
      return heard;
    }
  }
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return ok();
  joined_.reset();
  end.part();
  greeted_ = false;
  heard_.clear();
  return waiting_ ? ok() : meet();
}

Status BusLink::hear_lines(plc::BusEnd& end) {
  for (std::size_t stop; (stop = heard_.find('\n')) != std::string::npos; heard_.erase(0, stop + 1))
    if (const Status heard = end.hear(std::string_view(heard_).substr(0, stop)); !heard)
      return heard;
  return heard_.size() < longest_line ? ok()
                                      : Status(fail("the other end of the bus tells no end"));
}

void BusLink::tell(plc::BusEnd& end) {
  if (joined_ && !greeted_) greet(end);
  for (const std::string& line : end.take_lines())
    if (joined_) send(line);
}

void BusLink::begin(plc::BusEnd& end) {
  if (joined_) greet(end);
}

void BusLink::greet(plc::BusEnd& end) {
  greeted_ = true;
  send(end.hello());
}

/// A partner that takes no more is seen by what it does not answer.
void BusLink::send(const std::string& line) {
  const std::string whole = line + '\n';
  for (std::string_view left = whole; !left.empty();) {
    const ssize_t sent =
        ::send(joined_.get(), left.data(), left.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return;
    left.remove_prefix(static_cast<std::size_t>(sent));
  }
}

}  // namespace fieldproof::hosting
