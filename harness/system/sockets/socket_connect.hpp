// Sockets that are connected to a host.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/system/sockets/socket_address.hpp"
#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"

namespace fieldproof::os {

/// A host whose addresses have been looked up, so that connecting to it again asks nobody.
class RemoteHost {
 public:
  /// The error is the cause alone: "cannot find host 'plc' (...); write its address".
  static Result<RemoteHost> find(const std::string& host);

  /// A non-blocking socket, connected to the first of its addresses that takes it. `type`:
  /// SOCK_STREAM (TCP, without delay of small packets; at most 3 s) or SOCK_DGRAM (UDP: nothing is
  /// sent yet). One without a descriptor: the host has refused the connection. Errors: "cannot
  /// connect to plc:2004: no answer within 3 s; ...", or interrupted.
  Result<UniqueFd> connect(std::uint16_t port, int type);
  /// Of the last connect that gave no descriptor: nobody listens on that port. Else the connection
  /// stood, and was reset before it was known to.
  bool nobody_listens() const { return nobody_listens_; }

 private:
  std::string host_;
  std::vector<SocketAddress> addresses_;
  bool nobody_listens_ = false;
};

/// The same without waiting: a connection that is on its way, or refused. Of a host that cannot be
/// found or reached: refused.
UniqueFd begin_connecting(const SocketName& name, int type);

/// A socket to "HOST:PORT" as `RemoteHost::connect` makes it; a refusal is an error: "cannot
/// connect to plc:2004: nothing listens there; start ...".
Result<UniqueFd> connect_socket(const std::string& where, int type);

/// Does the server there take one more client? Not: it refuses, or closes before it says so.
bool takes_another_client(const std::string& where);

/// How long TCP has found the way there and back to take.
Duration round_trip(int fd);

/// What a refused connection means to an engineer.
inline constexpr const char* refused_advice =
    "nothing listens there; start the device or serial server, or correct the port";

}  // namespace fieldproof::os
