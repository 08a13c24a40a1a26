#include "harness/endpoints/serial_ports/rfc2217_session.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <algorithm>

#include "harness/system/sockets/socket_connect.hpp"

namespace fieldproof::endpoints {

namespace {

Bytes big_endian(int value) {
  const auto bits = static_cast<std::uint32_t>(value);
  return {static_cast<Byte>(bits >> 24), static_cast<Byte>(bits >> 16),
          static_cast<Byte>(bits >> 8), static_cast<Byte>(bits)};
}

Byte parity_code(char parity) { return parity == 'O' ? 2 : parity == 'E' ? 3 : 1; }

unsigned number(const Bytes& value) {
  unsigned result = 0;
  for (const Byte byte : value) result = result << 8 | byte;
  return result;
}

/// What a server says in words before it hangs up: "Port already in use".
std::string words(const std::deque<Burst>& received) {
  std::string text;
  for (const Burst& burst : received)
    for (const Byte byte : burst.bytes)
      if (text.size() < 200) text += byte >= ' ' && byte < 127 ? static_cast<char>(byte) : ' ';
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

}  // namespace

Rfc2217Session::Rfc2217Session(std::string where, line::LineSettings settings, Direction direction,
                               Duration patience)
    : where_(std::move(where)), settings_(settings), direction_(direction), patience_(patience) {}

Error Rfc2217Session::cannot_open(const std::string& why) const {
  return fail(fmt::format("cannot open {}: {}", name(), why));
}

Status Rfc2217Session::open() {
  Result<os::UniqueFd> fd = os::connect_socket(where_, SOCK_STREAM);
  if (!fd) return fd.error();
  link_.emplace(std::move(*fd), name(), clock_);
  decoder_ = {};
  negotiator_ = {};
  // What comes until the purge is the server's greeting, or older than this connection.
  std::deque<Burst> from_before = std::exchange(received_, {});
  Status opened = negotiate();
  if (opened) opened = set_up();
  if (!opened && link_->dead())
    while (listen(now())) {
    }  // its last words
  const std::string said = words(std::exchange(received_, std::move(from_before)));
  if (!opened && link_->dead() && !said.empty()) {
    return cannot_open(
        fmt::format("the server says '{}' and closes the connection; see who uses the port, and "
                    "the connector line of its "
                    "ser2net.yaml",
                    said));
  }
  return opened;
}

Status Rfc2217Session::negotiate() {
  if (const Result<Sent> sent = link_->send(telnet::Negotiator::opening()); !sent)
    return sent.error();
  const Time give_up = now() + patience_;
  while (!negotiator_.missing().empty() && negotiator_.refused().empty() && now() < give_up)
    if (const Status heard = listen(give_up); !heard) return heard;
  if (negotiator_.missing().empty()) return ok();
  const std::string what = negotiator_.refused().empty()
                               ? "does not agree to " + negotiator_.missing()
                               : "refuses " + negotiator_.refused();
  return cannot_open(
      fmt::format("the server {}; in its ser2net.yaml write `accepter: telnet(rfc2217),tcp,PORT`, "
                  "or see that this is the port of an "
                  "RFC 2217 server",
                  what));
}

Status Rfc2217Session::set_up() {
  // In the order that RFC 2217, 2 recommends: not every parity goes with every number of data bits.
  const std::string to = line::to_string(settings_);
  Status done = set(telnet::set_baud_rate, big_endian(settings_.baud), to + " (speed)");
  if (done)
    done =
        set(telnet::set_data_size, {static_cast<Byte>(settings_.data_bits)}, to + " (data bits)");
  if (done)
    done = set(telnet::set_parity, {parity_code(settings_.parity)},
               to + " (parity: 1 none, 2 odd, 3 even)");
  if (done)
    done =
        set(telnet::set_stop_size, {static_cast<Byte>(settings_.stop_bits)}, to + " (stop bits)");
  if (done) done = set(telnet::set_control, {telnet::no_flow_control}, "no flow control");
  if (done && direction_ == Direction::rts) done = set_rts(false);
  if (!done) return done;
  // Not every server answers this one as RFC 2217 has it, and one that notifies no errors can still
  // be used.
  const Byte errors =
      telnet::overrun_error | telnet::parity_error | telnet::framing_error | telnet::break_detect;
  if (const Result<Sent> sent =
          link_->send(telnet::command(telnet::set_line_state_mask, {{errors}}));
      !sent)
    return sent.error();
  return set(telnet::purge_data, {telnet::purge_both}, "empty buffers");
}

bool Rfc2217Session::ended() {
  if (!link_->dead()) static_cast<void>(listen(now()));
  return link_->dead();
}

/// Takes the next of what the server says, if it comes until `deadline`.
Status Rfc2217Session::listen(Time deadline) {
  // A server without TCP_NODELAY holds the rest of an answer until its first part is acknowledged:
  // up to 40 ms later.
  const int yes = 1;
  ::setsockopt(link_->fd(), IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
  const Result<Burst> burst = link_->receive(deadline);
  if (!burst) return burst.error();
  if (!burst->bytes.empty()) unproven_ = false;
  Bytes replies;
  for (telnet::Message& message : decoder_.decode(burst->bytes)) {
    if (Bytes* data = std::get_if<Bytes>(&message)) {
      received_.push_back({std::move(*data), burst->start, {}});
    } else if (const auto* notification = std::get_if<telnet::Notification>(&message)) {
      take(*notification);
    } else {
      const Bytes reply = negotiator_.answer(std::get<telnet::Negotiation>(message));
      replies.insert(replies.end(), reply.begin(), reply.end());
    }
  }
  if (replies.empty()) return ok();
  const Result<Sent> sent = link_->send(replies);
  return sent ? ok() : Status(sent.error());
}

void Rfc2217Session::take(const telnet::Notification& notification) {
  if (notification.command < telnet::answer || notification.value.empty()) return;
  const auto command = static_cast<Byte>(notification.command - telnet::answer);
  if (command != telnet::notify_line_state) {
    confirmed_[command] = notification.value;
    return;
  }
  const Byte state = notification.value.front();
  line_errors_.overruns += (state & telnet::overrun_error) != 0;
  line_errors_.parity += (state & telnet::parity_error) != 0;
  line_errors_.framing += (state & telnet::framing_error) != 0;
  line_errors_.breaks += (state & telnet::break_detect) != 0;
}

/// What the server confirms the command with.
Result<Bytes> Rfc2217Session::ask(telnet::Command command, const Bytes& value,
                                  const std::string& what) {
  confirmed_.erase(command);
  if (const Result<Sent> sent = link_->send(telnet::command(command, value)); !sent)
    return sent.error();
  const Time give_up = now() + patience_;
  while (!confirmed_.contains(command)) {
    if (now() >= give_up) {
      return fail(
          fmt::format("cannot set {} to {}: the server does not confirm it within {:g} s; see that "
                      "its host is on, and that the "
                      "connector in its ser2net.yaml is a serial port that has this "
                      "(`serialdev,/dev/ttyUSB0,9600n81,local`)",
                      name(), what, to_ms(patience_) / 1000));
    }
    if (const Status heard = listen(give_up); !heard) return heard.error();
  }
  return confirmed_.at(command);
}

Status Rfc2217Session::set(telnet::Command command, const Bytes& value, const std::string& what) {
  const Result<Bytes> taken = ask(command, value, what);
  if (!taken) return taken.error();
  if (*taken == value) return ok();
  return fail(
      fmt::format("cannot set {} to {}: the server answers {} to {}; see that its adapter offers "
                  "it, and that the connector in its "
                  "ser2net.yaml fixes nothing",
                  name(), what, number(*taken), number(value)));
}

Status Rfc2217Session::set_rts(bool on) {
  return set(telnet::set_control, {on ? telnet::rts_on : telnet::rts_off},
             on ? "RTS on; leave rs485 out where the adapter switches by itself"
                : "RTS off; leave rs485 out where the adapter switches by itself");
}

Result<Sent> Rfc2217Session::send(ByteView bytes) {
  if (direction_ == Direction::rts)
    if (const Status on = set_rts(true); !on) return on.error();
  Sent sent;
  sent.start = std::max(now(), sent_until_);
  if (const Result<Sent> handed_over = link_->send(telnet::escaped(bytes)); !handed_over)
    return handed_over.error();
  const Duration on_line = settings_.character_time() * static_cast<Duration::rep>(bytes.size());
  sent_until_ = sent.end = paced_ ? sent.start + on_line : now();
  unproven_ = true;
  while (now() < sent.end)
    if (const Status heard = listen(sent.end); !heard) return heard.error();
  if (direction_ == Direction::rts)
    if (const Status off = set_rts(false); !off) return off.error();
  return sent;
}

Result<Burst> Rfc2217Session::receive(Time deadline) {
  const bool waiting = deadline > now();
  do {
    if (!received_.empty()) {
      Burst first = std::move(received_.front());
      received_.pop_front();
      return first;
    }
    if (const Status heard = listen(deadline); !heard && received_.empty()) return heard.error();
  } while (!received_.empty() || now() < deadline);
  if (waiting && unproven_) {
    const Result<Bytes> alive =
        ask(telnet::set_control, {telnet::ask_flow_control}, "a sign of life");
    if (!alive && alive.error().interrupted) return alive.error();
    if (!alive && !link_->dead()) {
      return fail(
          fmt::format("cannot receive from {}: the server does not answer any more; see that its "
                      "host and the network are up",
                      name()));
    }
    if (!alive) return alive.error();
  }
  return Burst{{}, now(), {}};
}

}  // namespace fieldproof::endpoints
