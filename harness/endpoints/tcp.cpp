#include "harness/endpoints/tcp.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>

#include "harness/endpoints/fd_link.hpp"
#include "harness/endpoints/interrupt.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/endpoints/socket_address.hpp"
#include "harness/endpoints/system_calls.hpp"
#include "src/line/settings.hpp"

namespace fieldproof {

namespace {

constexpr int connect_limit_ms = 3000;

/// 0, or the errno that says why not.
int finish_connect(int fd) {
  std::array<pollfd, 2> fds{pollfd{fd, POLLOUT, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
  const int ready = ::poll(fds.data(), fds.size(), connect_limit_ms);
  if (interrupted()) return EINTR;
  if (ready == 0) return ETIMEDOUT;
  if (ready < 0) return errno;
  int error = 0;
  socklen_t size = sizeof error;
  return ::getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

int connect_to(const addrinfo& address, UniqueFd& fd) {
  fd.reset(::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, address.ai_protocol));
  if (!fd) return errno;
  if (::connect(fd.get(), address.ai_addr, address.ai_addrlen) == 0) return 0;
  return errno == EINPROGRESS || errno == EINTR ? finish_connect(fd.get()) : errno;
}

std::string advice(int error) {
  switch (error) {
    case ECONNREFUSED: return "nothing listens there; start the device or serial server, or correct the port";
    case ETIMEDOUT: return "no answer within 3 s; see that the host is on and that no firewall drops the connection";
    default: return errno_text(error) + "; correct the address";
  }
}

Result<UniqueFd> connect(const std::string& where) {
  const std::string start = "cannot connect to " + where + ": ";
  const Result<AddressInfo> list = resolve(where, false);
  if (!list) return fail(start + list.error().message);
  UniqueFd fd;
  int error = 0;
  for (const addrinfo* one = list->get(); one; one = one->ai_next) {
    error = connect_to(*one, fd);
    if (error == 0 || interrupted()) break;
  }
  if (interrupted()) return interrupted_error("connect to", where);
  if (error != 0) return fail(start + advice(error));
  const int yes = 1;
  ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  return fd;
}

class TcpEndpoint final : public Endpoint {
 public:
  TcpEndpoint(std::string where, Duration floor) : where_(std::move(where)) {
    capabilities_.real_device = true;
    capabilities_.timing_floor = floor;
  }

  Status open() {
    Result<UniqueFd> fd = connect(where_);
    if (!fd) return fd.error();
    link_.emplace(std::move(*fd), describe(), clock_);
    return ok();
  }

  const Capabilities& capabilities() const override { return capabilities_; }
  std::string describe() const override { return "tcp:" + where_; }
  Time now() const override { return clock_.now(); }
  /// A socket has no wire; pauses in characters are meant at the default speed.
  Duration character_time() const override { return LineSettings{}.character_time(); }
  Status begin(const nlohmann::json&) override { return link_->dead() ? open() : ok(); }
  Result<Sent> send(ByteView bytes) override { return link_->send(bytes); }
  Result<Burst> receive(Time deadline) override { return link_->receive(deadline); }

 private:
  Capabilities capabilities_;
  std::string where_;
  RunClock clock_;
  std::optional<FdLink> link_;
};

}  // namespace

Result<std::unique_ptr<Endpoint>> open_tcp(const EndpointName& name) {
  const Result<Duration> floor = timing_floor(name);
  if (!floor) return floor.error();
  auto endpoint = std::make_unique<TcpEndpoint>(name.target, *floor);
  if (const Status opened = endpoint->open(); !opened) return opened.error();
  return std::unique_ptr<Endpoint>(std::move(endpoint));
}

}  // namespace fieldproof
