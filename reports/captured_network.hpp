// The events of network links as packets, as a capture between bench and device would show them.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "reports/ip_packet.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::reports {

/// An IPv4 packet with TCP or UDP.
struct CapturedPacket {
  bool sent = false;  // by the bench
  Time time{};
  Bytes bytes;
  std::string comment;
};

/// The bench is 192.0.2.1, the device 192.0.2.2 (addresses for examples, RFC 5737). The side that
/// listens has the port of the events; the other side has one of its own for each link of a run.
///
/// Known are the bytes of each piece, who opened and closed, and how. Made up are acknowledgements
/// and sequence numbers, as they follow from that. A connection that the other side resets before a
/// byte has gone either way is shown as refused: a capture of the results cannot tell that from one
/// that was taken and dropped at once.
class CapturedNetwork {
 public:
  /// Of the next case, in the order of time. `comment_of` says what an event belongs to.
  std::vector<CapturedPacket> packets(
      const std::vector<results::Event>& exchange,
      const std::function<std::string(const results::Event&)>& comment_of);

  static bool is_of_network(const results::Event& event) {
    return event.port != 0 && event.kind != results::Event::Kind::note;
  }

 private:
  enum Side : std::size_t { bench, device };
  /// A connection, or a pair of datagram ports.
  struct Link {
    IpEnd ends[2];                // by side
    std::uint32_t sequence[2]{};  // of the next byte that a side sends
    Side opener = bench;
    bool asked = false, stands = false;  // SYN was sent; it was taken
    bool fin[2]{};
    Time opened{};
    std::string comment{};
  };

  void add(const results::Event& event, const std::string& comment);
  void add_tcp(const results::Event& event, const std::string& comment);
  Link& link_of(const results::Event& event);
  Link new_link(const results::Event& event, Side opener);
  void ask(Link& link, Time time, const std::string& comment);
  void stand(Link& link);
  void end(Link& link, const results::Event& event, const std::string& comment);
  void segment(Link& link, Side from, std::uint8_t flags, ByteView bytes, Time time,
               const std::string& comment);

  std::map<std::string, Link> links_;  // of this case, by name and transport
  std::vector<CapturedPacket> packets_;
  std::uint32_t links_so_far_ = 0;
  std::uint16_t ids_[2]{};
};

}  // namespace fieldproof::reports
