#include "harness/probe/servers.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/probe/diagnosis.hpp"

namespace fieldproof::probe {

using endpoints::Endpoint;
using harness::Protocol;
using ServerKind = ServerFinding::Kind;

namespace {

constexpr Duration quiet = 100ms;           // no further byte for so long: what is no frame is over
constexpr int times = 3;                    // that a server is asked
constexpr std::size_t most_heard = 70'000;  // bytes of one answer

std::string_view name_of(Transport transport) {
  return transport == Transport::tcp ? "TCP" : "UDP";
}

/// What one question brought.
struct Answer {
  enum class End { none, refused, ended };
  Bytes bytes{};
  End end = End::none;
  Duration took{};  // to the first byte
};

/// One port of one endpoint.
class Port {
 public:
  Port(Endpoint& endpoint, const Protocol& protocol, Transport transport, Duration wait)
      : endpoint_(endpoint), protocol_(protocol), transport_(transport), wait_(wait) {}

  /// On a link of its own; `spoken`: whose frames tell that the answer is complete.
  Result<Answer> ask(const Protocol& spoken, ByteView request) {
    const Result<LinkId> link = endpoint_.open(transport_, protocol_.port_for(transport_));
    if (!link) return link.error();
    const bool refused = transport_ == Transport::tcp && endpoint_.was_refused();
    Result<Answer> answer = refused ? Result<Answer>(Answer{.end = Answer::End::refused})
                                    : exchange(*link, spoken, request);
    (void)endpoint_.close(*link, Closing::rst);  // the place is free again at once
    return answer;
  }

 private:
  Result<Answer> exchange(LinkId link, const Protocol& spoken, ByteView request) {
    const Result<Sent> sent = endpoint_.send(request, link);
    if (!sent) return sent.error();
    Answer answer;
    for (Time until = sent->end + wait_;;) {
      Result<Burst> burst = endpoint_.receive(until);
      if (!burst) return burst.error();
      if (burst->link != link && !(burst->bytes.empty() && burst->event == LinkEvent::data))
        continue;  // of a link of before
      if (burst->event == LinkEvent::closed || burst->event == LinkEvent::reset) {
        answer.end = Answer::End::ended;
        return answer;
      }
      if (burst->bytes.empty()) return answer;
      if (answer.bytes.empty()) answer.took = burst->start - sent->end;
      answer.bytes.insert(answer.bytes.end(), burst->bytes.begin(), burst->bytes.end());
      if (spoken.frame_length(answer.bytes) || answer.bytes.size() > most_heard) return answer;
      until = endpoint_.now() + quiet;
    }
  }

  Endpoint& endpoint_;
  const Protocol& protocol_;
  Transport transport_;
  Duration wait_;
};

bool is_reply(const Protocol& protocol, ByteView request, const Answer& answer) {
  return protocol.frame_length(answer.bytes) && protocol.is_reply_to_probe(request, answer.bytes);
}

/// The greatest number that a read is answered for, sought by halves; nothing: not even one.
Result<std::optional<unsigned>> most_of(Port& port, const Protocol& protocol,
                                        const harness::ReadLimit& limit) {
  const auto taken = [&](unsigned count) -> Result<bool> {
    const Bytes request = limit.request(count);
    const Result<Answer> answer = port.ask(protocol, request);
    if (!answer) return answer.error();
    return protocol.memory()->answers(request, answer->bytes) &&
           static_cast<bool>(protocol.memory()->digits_in(answer->bytes));
  };
  unsigned good = 0, bad = limit.most + 1;
  for (unsigned next = limit.printed; bad - good > 1; next = good + (bad - good) / 2) {
    const Result<bool> answered = taken(next);
    if (!answered) return answered.error();
    (*answered ? good : bad) = next;
    if (next == limit.printed && *answered) {  // most keep to it: one more tells
      const Result<bool> more = taken(next + 1);
      if (!more) return more.error();
      (*more ? good : bad) = next + 1;
    }
  }
  return good == 0 ? std::optional<unsigned>() : std::optional(good);
}

Result<std::vector<std::string>> limits_of(Port& port, const Protocol& protocol) {
  std::vector<std::string> texts;
  for (const harness::ReadLimit& limit : protocol.probing()->read_limits()) {
    const Result<std::optional<unsigned>> most = most_of(port, protocol, limit);
    if (!most) return most.error();
    if (!*most)
      texts.push_back(fmt::format("{}: none is answered", limit.what));
    else
      texts.push_back(fmt::format("{}: {}{}", limit.what, **most,
                                  **most == limit.printed
                                      ? ", as printed"
                                      : fmt::format("; printed is {}", limit.printed)));
  }
  return texts;
}

/// One port, from its own protocol to the others.
class Look {
 public:
  Look(Endpoint& endpoint, const Protocol& protocol, Transport transport,
       const harness::Protocols& known, Duration wait)
      : endpoint_(endpoint),
        protocol_(protocol),
        transport_(transport),
        known_(known),
        port_(endpoint, protocol, transport, wait) {}

  Result<ServerFinding> look() {
    const Bytes request = protocol_.probe(1, {});
    const Result<Answer> answer = port_.ask(protocol_, request);
    if (!answer) {
      if (answer.error().interrupted) return answer.error();
      return finding(ServerKind::unreachable, answer.error().message,
                     "see that the device is on, that its address is right and that no firewall "
                     "stands between");
    }
    if (is_reply(protocol_, request, *answer)) return server(answer->took);
    // Datagrams have no connection that could end: the host says that nobody has the port.
    if (answer->end == Answer::End::refused ||
        (transport_ == Transport::udp && answer->end == Answer::End::ended))
      return finding(ServerKind::refused, "nothing listens there",
                     "set the driver of the module as server of this protocol: a module has one "
                     "server driver, and the port of the other one refuses; or correct the port");
    return by_others(*answer);
  }

 private:
  ServerFinding finding(ServerKind kind, std::string text, std::string advice) const {
    return {kind,
            &protocol_,
            transport_,
            protocol_.port_for(transport_),
            fmt::format("{} over {} at {}: {}", protocol_.name(), name_of(transport_),
                        endpoint_.describe(), text),
            std::move(advice)};
  }

  Result<ServerFinding> server(Duration first) {
    Duration fastest = first, slowest = first;
    int answered = 1;
    for (int i = 1; i < times; ++i) {
      const Bytes request = protocol_.probe(1, {});
      const Result<Answer> again = port_.ask(protocol_, request);
      if (!again) return again.error();
      if (!is_reply(protocol_, request, *again)) continue;
      ++answered;
      fastest = std::min(fastest, again->took);
      slowest = std::max(slowest, again->took);
    }
    ServerFinding found =
        finding(ServerKind::server,
                fmt::format("answers in {:.1f} to {:.1f} ms", to_ms(fastest), to_ms(slowest)),
                answered == times ? ""
                                  : "only some questions are answered: see that others leave it a "
                                    "channel");
    Result<std::vector<std::string>> limits = limits_of(port_, protocol_);
    if (!limits) return limits.error();
    found.limits = std::move(*limits);
    return found;
  }

  Result<ServerFinding> by_others(const Answer& own) {
    for (const Protocol* other : known_) {
      if (other == &protocol_ || !is_network_server(*other)) continue;
      const Bytes request = other->probe(1, {});
      const Result<Answer> answer = port_.ask(*other, request);
      if (!answer) return answer.error();
      if (!is_reply(*other, request, *answer)) continue;
      ServerFinding found =
          finding(ServerKind::other, fmt::format("a server of {} answers there", other->name()),
                  fmt::format("add protocol={} behind the '?' of the endpoint, or correct the port",
                              other->name()));
      found.protocol = other;
      return found;
    }
    if (own.end == Answer::End::ended)
      return finding(ServerKind::ended, "the connection is taken, and ended at once",
                     "all channels may be taken: close other clients; or the host table of the "
                     "module lacks the address of this computer");
    if (!own.bytes.empty())
      return finding(ServerKind::garbage, "the answer is no reply: " + shown(own.bytes),
                     "another service has this port: correct it");
    if (transport_ == Transport::udp)
      return finding(ServerKind::silent, "no answer",
                     "nothing listens there, or the host table of the module lacks the address of "
                     "this computer, or a firewall drops datagrams");
    return finding(ServerKind::silent, "the connection is taken, and nothing is answered",
                   "all channels may be taken, or another service has this port; a slow device "
                   "wants --wait");
  }

  Endpoint& endpoint_;
  const Protocol& protocol_;
  Transport transport_;
  harness::Protocols known_;
  Port port_;
};

/// What over connections looks alike is told apart by datagrams: they need no channel.
void tell_apart(ServerFinding& connections, const ServerFinding& datagrams) {
  const ServerKind kind = connections.kind;
  const bool ended = kind == ServerKind::ended;
  if (datagrams.is_server() && (ended || kind == ServerKind::refused || kind == ServerKind::silent))
    connections.advice =
        "over UDP the module answers, so that its driver and its host table are right: all "
        "channels are taken, close other clients";
  if (ended && datagrams.kind == ServerKind::silent)
    connections.advice =
        "over UDP it is silent, too: most likely the host table of the module lacks the address "
        "of this computer; else all channels are taken: close other clients";
}

}  // namespace

std::string_view to_string(ServerKind kind) {
  switch (kind) {
    case ServerKind::server: return "found";
    case ServerKind::other: return "other server";
    case ServerKind::refused: return "refused";
    case ServerKind::unreachable: return "unreachable";
    case ServerKind::ended: return "ended";
    case ServerKind::silent: return "silence";
    case ServerKind::garbage: return "garbage";
  }
  return "";
}

bool is_network_server(const Protocol& protocol) {
  return protocol.on_network() && protocol.memory() && !protocol.probe(1, {}).empty();
}

Result<std::vector<ServerFinding>> find_servers(const NetworkOpener& open,
                                                const std::vector<const Protocol*>& wanted,
                                                const harness::Protocols& known, Duration wait) {
  std::vector<ServerFinding> findings;
  for (const Protocol* protocol : wanted) {
    Result<std::unique_ptr<Endpoint>> endpoint = open(*protocol);
    if (!endpoint) return endpoint.error();
    std::vector<ServerFinding> of_one;
    for (const Transport transport : {Transport::tcp, Transport::udp}) {
      const endpoints::Capabilities& can = (*endpoint)->capabilities();
      if (transport == Transport::tcp ? !can.connections : !can.datagrams) continue;
      Result<ServerFinding> found = Look(**endpoint, *protocol, transport, known, wait).look();
      if (!found) return found.error();
      of_one.push_back(std::move(*found));
    }
    if (of_one.size() == 2) tell_apart(of_one[0], of_one[1]);
    std::ranges::move(of_one, std::back_inserter(findings));
  }
  return findings;
}

}  // namespace fieldproof::probe
