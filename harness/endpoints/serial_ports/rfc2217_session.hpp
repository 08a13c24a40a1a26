// A serial port of another host through an RFC 2217 server: one TCP connection at a time.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>

#include "harness/endpoints/serial_ports/rfc2217_telnet.hpp"
#include "harness/endpoints/serial_ports/serial_settings.hpp"
#include "harness/system/fd_link.hpp"
#include "harness/system/sockets/socket_connect.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::endpoints {

class Rfc2217Session {
 public:
  /// `patience`: how long the server may take to confirm anything.
  Rfc2217Session(std::string where, line::LineSettings settings, Direction direction,
                 Duration patience = 3s);

  /// Connects, negotiates, sets speed and format, and purges the server's buffers; each is
  /// confirmed by the server, or it is an error that says what to set in ser2net.yaml. After the
  /// end of a connection it opens a new one: what had come over the old one is still handed out.
  Status open();
  /// Has the connection ended? Looks, without waiting.
  bool ended();

  Duration round_trip() const { return os::round_trip(link_->fd()); }

  Time now() const { return clock_.now(); }
  /// The end is that of the last stop bit at the set speed, as far as a network lets one tell;
  /// where nothing paces what goes over the port, the moment at which it was handed over.
  Result<Sent> send(ByteView bytes);
  void has_no_wire() { paced_ = false; }
  /// As Endpoint::receive. A silence counts only if the server still answers us at its end: a dead
  /// server or network is an error, never a silence of the device.
  Result<Burst> receive(Time deadline);

  /// Errors that the server has notified, since the last call.
  LineErrorCounts take_line_errors() { return std::exchange(line_errors_, {}); }

 private:
  Status negotiate();
  Status set_up();
  Status listen(Time deadline);
  void take(const telnet::Notification& notification);
  Result<Bytes> ask(telnet::Command command, const Bytes& value, const std::string& what);
  Status set(telnet::Command command, const Bytes& value, const std::string& what);
  Status set_rts(bool on);
  std::string name() const { return "rfc2217:" + where_; }
  Error cannot_open(const std::string& why) const;

  std::string where_;
  line::LineSettings settings_;
  Direction direction_;
  Duration patience_;
  os::RunClock clock_;
  std::optional<os::FdLink> link_;
  telnet::Decoder decoder_;
  telnet::Negotiator negotiator_;
  std::map<Byte, Bytes>
      confirmed_;  // by command of the client: the value that the server has answered
  std::deque<Burst> received_;
  LineErrorCounts line_errors_;
  Time sent_until_{};
  bool paced_ = true;
  bool unproven_ = false;  // something was sent, and nothing has come from the server since
};

}  // namespace fieldproof::endpoints
