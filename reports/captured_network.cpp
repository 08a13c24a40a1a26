#include "reports/captured_network.hpp"

#include <algorithm>

namespace fieldproof::reports {

using results::Event;

namespace {

constexpr std::uint32_t bench_address = 0xC0000201, device_address = 0xC0000202;
/// Dynamic ports (RFC 6335): one for each link, as long as there are.
constexpr std::uint16_t first_own_port = 49'152;
constexpr std::uint32_t own_ports = 16'384;
constexpr std::uint32_t first_sequence[2] = {1'000'000, 2'000'000};

}  // namespace

std::vector<CapturedPacket> CapturedNetwork::packets(
    const std::vector<Event>& exchange,
    const std::function<std::string(const Event&)>& comment_of) {
  links_.clear();
  packets_.clear();
  for (const Event& event : exchange)
    if (is_of_network(event)) add(event, comment_of(event));
  for (auto& [name, link] : links_) stand(link);
  // That a connection stands is known, and noted, later than it was so.
  std::ranges::stable_sort(packets_, {}, &CapturedPacket::time);
  return std::exchange(packets_, {});
}

CapturedNetwork::Link CapturedNetwork::new_link(const Event& event, Side opener) {
  Link link;
  link.opener = opener;
  const auto own = static_cast<std::uint16_t>(first_own_port + links_so_far_++ % own_ports);
  link.ends[bench] = {bench_address, opener == bench ? own : event.port};
  link.ends[device] = {device_address, opener == bench ? event.port : own};
  std::ranges::copy(first_sequence, link.sequence);
  return link;
}

/// Of what nobody has opened, the bench has.
CapturedNetwork::Link& CapturedNetwork::link_of(const Event& event) {
  const std::string name = event.link + (event.transport == Transport::udp ? "/udp" : "/tcp");
  const bool opened = event.kind == Event::Kind::opened;
  const auto found = links_.find(name);
  if (found != links_.end() && !opened) return found->second;
  if (found != links_.end()) stand(found->second);
  const Side opener = opened && event.by_device ? device : bench;
  return links_.insert_or_assign(name, new_link(event, opener)).first->second;
}

void CapturedNetwork::add(const Event& event, const std::string& comment) {
  if (event.transport == Transport::tcp) return add_tcp(event, comment);
  Link& link = link_of(event);
  if (event.kind != Event::Kind::sent && event.kind != Event::Kind::received) return;
  const Side from = event.kind == Event::Kind::sent ? bench : device;
  const ByteView bytes = ByteView(event.bytes).first(std::min(event.bytes.size(), most_ip_payload));
  packets_.push_back({from == bench, event.end,
                      udp_packet(link.ends[from], link.ends[1 - from], bytes, ids_[from]++),
                      comment});
}

void CapturedNetwork::add_tcp(const Event& event, const std::string& comment) {
  Link& link = link_of(event);
  if (!link.asked) ask(link, event.start, comment);
  switch (event.kind) {
    case Event::Kind::note:
    case Event::Kind::opened: return;
    case Event::Kind::closed:
    case Event::Kind::reset: return end(link, event, comment);
    case Event::Kind::sent:
    case Event::Kind::received: break;
  }
  stand(link);
  const Side from = event.kind == Event::Kind::sent ? bench : device;
  const auto say = [&](ByteView left) {
    while (!left.empty()) {
      const ByteView part = left.first(std::min(left.size(), most_ip_payload));
      segment(link, from, tcp_psh | tcp_ack, part, event.end, comment);
      left = left.subspan(part.size());
    }
  };
  say(event.bytes);
  if (event.extract.empty()) return;
  link.sequence[from] += static_cast<std::uint32_t>(event.extract.left_out(event.bytes.size()));
  say(event.extract.tail);
}

void CapturedNetwork::ask(Link& link, Time time, const std::string& comment) {
  link.asked = true;
  link.opened = time;
  link.comment = comment;
  segment(link, link.opener, tcp_syn, {}, time, comment);
}

/// The rest of the handshake.
void CapturedNetwork::stand(Link& link) {
  if (!link.asked || std::exchange(link.stands, true)) return;
  const Side other = link.opener == bench ? device : bench;
  segment(link, other, tcp_syn | tcp_ack, {}, link.opened, link.comment);
  segment(link, link.opener, tcp_ack, {}, link.opened, link.comment);
}

void CapturedNetwork::end(Link& link, const Event& event, const std::string& comment) {
  const Side from = event.by_device ? device : bench;
  const Side other = from == bench ? device : bench;
  const bool refused = event.kind == Event::Kind::reset && !link.stands && from != link.opener;
  if (!refused) stand(link);
  link.stands = true;
  if (event.kind == Event::Kind::reset)
    return segment(link, from, tcp_rst | tcp_ack, {}, event.end, comment);
  if (std::exchange(link.fin[from], true)) return;
  segment(link, from, tcp_fin | tcp_ack, {}, event.end, comment);
  segment(link, other, tcp_ack, {}, event.end, comment);
}

void CapturedNetwork::segment(Link& link, Side from, std::uint8_t flags, ByteView bytes, Time time,
                              const std::string& comment) {
  const Side to = from == bench ? device : bench;
  // A refusal answers to a SYN, and has no sequence of its own.
  const bool nothing_before = link.sequence[from] == first_sequence[from] && (flags & tcp_rst);
  const std::uint32_t sequence = nothing_before ? 0 : link.sequence[from];
  packets_.push_back({from == bench, time,
                      tcp_packet({link.ends[from], link.ends[to], sequence,
                                  flags & tcp_ack ? link.sequence[to] : 0, flags, bytes},
                                 ids_[from]++),
                      comment});
  link.sequence[from] += static_cast<std::uint32_t>(bytes.size());
  if (flags & (tcp_syn | tcp_fin)) ++link.sequence[from];
}

}  // namespace fieldproof::reports
