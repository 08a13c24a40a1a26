// IPv4 packets around a TCP segment (RFC 9293) or a UDP datagram, for a capture of what went over
// sockets: their headers are made up, their bytes are not.
#pragma once

#include <cstdint>

#include "src/base/bytes.hpp"

namespace fieldproof::reports {

struct IpEnd {
  std::uint32_t address = 0;  // 0xC0000201: 192.0.2.1
  std::uint16_t port = 0;
};

inline constexpr std::uint8_t tcp_fin = 0x01, tcp_syn = 0x02, tcp_rst = 0x04, tcp_psh = 0x08,
                              tcp_ack = 0x10;

struct TcpSegment {
  IpEnd from, to;
  std::uint32_t sequence = 0;      // of the first byte, or of SYN or FIN
  std::uint32_t acknowledged = 0;  // the next that is expected; 0 without tcp_ack
  std::uint8_t flags = 0;
  ByteView bytes{};
};

/// As many bytes fit behind the headers of either.
inline constexpr std::size_t most_ip_payload = 65'535 - 20 - 20;

/// Checksums are right. `id` counts the packets of a sender.
Bytes tcp_packet(const TcpSegment& segment, std::uint16_t id);
Bytes udp_packet(IpEnd from, IpEnd to, ByteView bytes, std::uint16_t id);

}  // namespace fieldproof::reports
