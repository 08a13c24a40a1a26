#include "harness/endpoints/network_name.hpp"

#include <fmt/format.h>

#include "harness/endpoints/kinds.hpp"
#include "harness/protocol.hpp"
#include "harness/system/sockets/socket_address.hpp"

namespace fieldproof::endpoints {

namespace {

constexpr const char* ports = "write a number from 1 to 65535";

/// Option `udp` as a port; 0 where it is none.
std::uint16_t udp_option(const EndpointName& name) {
  const Result<os::SocketName> read = os::parse_socket_name(':' + name.option("udp", ""));
  return read ? read->port.value_or(0) : 0;
}

Status check_options(const EndpointName& name) {
  if (name.options.contains("udp") && udp_option(name) == 0)
    return fail(fmt::format("udp is '{}', which is no port; {}", name.option("udp", ""), ports));
  if (const std::string shared = name.option("shared", "on"); shared != "on" && shared != "off")
    return fail(fmt::format(
        "shared is '{}'; write shared=off where the server lets nobody else in, or leave it out",
        shared));
  const std::string line = name.option("line", "raw");
  if (line != "raw")
    return fail(
        fmt::format("line is '{}'; a socket has no speed and format: write line=raw (one "
                    "line over the connection), or leave it out",
                    line));
  return ok();
}

Result<os::SocketName> read_target(const EndpointName& name) {
  Result<os::SocketName> read = os::parse_socket_name(name.target);
  if (read && read->host.empty()) return fail("there is no host; write HOST:PORT");
  return read;
}

}  // namespace

Status check_network_name(const EndpointName& name) {
  const Result<os::SocketName> read = read_target(name);
  if (!read) return read.error();
  if (read->port == 0) return fail(fmt::format("0 is no port; {}", ports));
  return check_options(name);
}

Status check_network_use(const EndpointName& name, const harness::Protocol& protocol) {
  if (!protocol.on_network() && !os::parse_socket_name(name.target)->port)
    return fail(
        fmt::format("there is no port, and a serial server has none of its own; write "
                    "{}:{}:PORT",
                    name.kind, name.target));
  if (protocol.on_network() && name.options.contains("line"))
    return fail("it needs links, and line=raw makes one line of a connection; leave line=raw out");
  if (protocol.on_network() && name.options.contains("shared"))
    return fail("its connections are shared with nobody; leave shared out");
  return ok();
}

Status check_listen_name(const EndpointName& name) {
  const std::string_view port = std::string_view(name.target).substr(name.target.starts_with(':'));
  if (!port.empty() && port.find_first_not_of("0123456789") == port.npos)
    return fail(
        fmt::format("{} is a port alone; write {}:127.0.0.1:{}, or the address of this "
                    "computer at which the device finds it",
                    port, name.kind, port));
  const Result<os::SocketName> read = read_target(name);
  return read ? check_options(name) : read.error();
}

NetworkPorts default_ports(const harness::Protocol& protocol) {
  return {{}, protocol.default_port(), protocol.datagram_port()};
}

NetworkPorts network_ports(const EndpointName& name, const harness::Protocol& protocol) {
  const os::SocketName read = *os::parse_socket_name(name.target);
  if (!kind_of(name).connections)
    return {read.host, 0, read.port.value_or(protocol.datagram_port())};
  return {read.host, read.port.value_or(protocol.default_port()), udp_option(name)};
}

}  // namespace fieldproof::endpoints
