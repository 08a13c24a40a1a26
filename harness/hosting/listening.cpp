#include "harness/hosting/listening.hpp"

#include <sys/socket.h>

namespace fieldproof::hosting {

namespace {

constexpr const char* loopback = "127.0.0.1";

}  // namespace

Result<os::SocketName> read_address(const std::string& text,
                                    std::optional<std::uint16_t> usual_port) {
  const std::string start = "cannot listen on " + text + ": ";
  const bool port_alone = text.find_first_not_of("0123456789") == std::string::npos;
  Result<os::SocketName> name = os::parse_socket_name(port_alone ? ':' + text : text);
  if (!name) return fail(start + name.error().message);
  if (name->host.empty()) name->host = loopback;
  if (!name->port) name->port = usual_port;
  if (!name->port) return fail(start + "there is no port; write PORT or HOST:PORT");
  return name;
}

Result<Listening> listen_on(const std::string& address, Transport transport,
                            std::optional<std::uint16_t> usual_port) {
  Result<os::SocketName> name = read_address(address, usual_port);
  if (!name) return name.error();
  Result<os::UniqueFd> socket =
      os::listen_socket(*name, transport == Transport::tcp ? SOCK_STREAM : SOCK_DGRAM);
  if (!socket) return socket.error();
  name->port = os::local_address(socket->get()).port();
  return Listening{std::move(*socket), std::move(*name)};
}

}  // namespace fieldproof::hosting
