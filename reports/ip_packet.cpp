#include "reports/ip_packet.hpp"

namespace fieldproof::reports {
namespace {

constexpr Byte tcp = 6, udp = 17;
constexpr std::size_t ip_header = 20;

void put(Bytes& packet, std::uint64_t value, int bytes) {
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8)
    packet.push_back(static_cast<Byte>(value >> shift));
}

/// The sum of all 16-bit words, carries added back (RFC 1071).
std::uint32_t sum_of(ByteView bytes, std::uint32_t sum = 0) {
  for (std::size_t i = 0; i < bytes.size(); ++i)
    sum += static_cast<std::uint32_t>(bytes[i]) << (i % 2 == 0 ? 8 : 0);
  while (sum >> 16) sum = (sum & 0xFFFF) + (sum >> 16);
  return sum;
}

void put_checksum(Bytes& packet, std::size_t at, std::uint32_t sum) {
  const std::uint32_t checksum = ~sum & 0xFFFF;
  packet[at] = static_cast<Byte>(checksum >> 8);
  packet[at + 1] = static_cast<Byte>(checksum);
}

/// The header, and behind it `body`, whose checksum stands at `checksum_at`.
Bytes ip_packet(Byte protocol, IpEnd from, IpEnd to, const Bytes& body, std::size_t checksum_at,
                std::uint16_t id) {
  Bytes packet{0x45, 0};
  put(packet, ip_header + body.size(), 2);
  put(packet, id, 2);
  put(packet, 0x4000, 2);  // not to be cut
  packet.push_back(64);    // time to live
  packet.push_back(protocol);
  put(packet, 0, 2);
  put(packet, from.address, 4);
  put(packet, to.address, 4);
  put_checksum(packet, 10, sum_of(packet));
  Bytes pseudo;  // what a checksum of the transport covers besides the body
  put(pseudo, from.address, 4);
  put(pseudo, to.address, 4);
  put(pseudo, protocol, 2);
  put(pseudo, body.size(), 2);
  packet.insert(packet.end(), body.begin(), body.end());
  std::uint32_t sum = sum_of(body, sum_of(pseudo));
  // A UDP checksum of 0 means that there is none.
  if (protocol == udp && sum == 0xFFFF) sum = 0;
  put_checksum(packet, ip_header + checksum_at, sum);
  return packet;
}

}  // namespace

Bytes tcp_packet(const TcpSegment& segment, std::uint16_t id) {
  Bytes body;
  put(body, segment.from.port, 2);
  put(body, segment.to.port, 2);
  put(body, segment.sequence, 4);
  put(body, segment.acknowledged, 4);
  put(body, 0x50, 1);  // five words of header
  put(body, segment.flags, 1);
  put(body, 0xFFFF, 2);  // window
  put(body, 0, 4);       // checksum, urgent pointer
  body.insert(body.end(), segment.bytes.begin(), segment.bytes.end());
  return ip_packet(tcp, segment.from, segment.to, body, 16, id);
}

Bytes udp_packet(IpEnd from, IpEnd to, ByteView bytes, std::uint16_t id) {
  Bytes body;
  put(body, from.port, 2);
  put(body, to.port, 2);
  put(body, 8 + bytes.size(), 2);
  put(body, 0, 2);
  body.insert(body.end(), bytes.begin(), bytes.end());
  return ip_packet(udp, from, to, body, 6, id);
}

}  // namespace fieldproof::reports
