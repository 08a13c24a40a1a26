#include "reports/captured_network.hpp"

#include <gmock/gmock.h>

namespace fieldproof::reports {
namespace {

using results::Event;

using testing::ElementsAre;

Event event(Event::Kind kind, const char* link, Time time, bool by_device = false,
            const char* hex = "") {
  Event one;
  one.kind = kind;
  one.link = link;
  one.start = one.end = time;
  one.by_device = by_device;
  one.bytes = *from_hex(hex);
  one.port = 502;
  return one;
}

Event datagram(Event::Kind kind, const char* link, const char* hex) {
  Event one = event(kind, link, 1ms, false, hex);
  one.transport = Transport::udp;
  one.port = 2005;
  return one;
}

std::uint32_t number(const Bytes& packet, std::size_t at, int bytes) {
  std::uint32_t value = 0;
  for (int i = 0; i < bytes; ++i) value = value << 8 | packet[at + static_cast<std::size_t>(i)];
  return value;
}

/// "> 49152 502 S 0 0": direction, ports, flags, then sequence and acknowledge number as each side
/// counts them from its SYN, and the bytes.
std::string shown(const CapturedPacket& packet) {
  const Bytes& b = packet.bytes;
  std::string text = packet.sent ? "> " : "< ";
  text += std::to_string(number(b, 20, 2)) + ' ' + std::to_string(number(b, 22, 2)) + ' ';
  if (b[9] == 17) return text + to_hex(ByteView(b).subspan(28));
  for (const auto& [flag, letter] :
       {std::pair{0x02, 'S'}, {0x01, 'F'}, {0x04, 'R'}, {0x08, 'P'}, {0x10, 'A'}})
    if (b[33] & flag) text += letter;
  const std::uint32_t first = packet.sent ? 1'000'000 : 2'000'000;
  const std::uint32_t sequence = number(b, 24, 4), acknowledged = number(b, 28, 4);
  text += ' ' + (sequence ? std::to_string(sequence - first) : "-");
  text += ' ' + (acknowledged ? std::to_string(acknowledged - (3'000'000 - first)) : "-");
  if (b.size() > 40) text += ' ' + to_hex(ByteView(b).subspan(40));
  return text;
}

std::vector<std::string> all(const std::vector<Event>& exchange) {
  CapturedNetwork network;
  std::vector<std::string> lines;
  for (const CapturedPacket& packet :
       network.packets(exchange, [](const Event& one) { return one.link; }))
    lines.push_back(shown(packet));
  return lines;
}

using enum Event::Kind;

TEST(CapturedNetwork, AConnectionIsSetUpUsedAndClosed) {
  EXPECT_THAT(
      all({event(opened, "", 0ms), event(sent, "", 1ms, false, "01 02 03"),
           event(received, "", 2ms, false, "0A 0B"), event(closed, "", 3ms),
           event(closed, "", 4ms, true)}),
      ElementsAre("> 49152 502 S 0 -", "< 502 49152 SA 0 1", "> 49152 502 A 1 1",
                  "> 49152 502 PA 1 1 01 02 03", "< 502 49152 PA 1 4 0A 0B", "> 49152 502 FA 4 3",
                  "< 502 49152 A 3 5", "< 502 49152 FA 3 5", "> 49152 502 A 5 4"));
}

TEST(CapturedNetwork, AResetGoesBehindWhatWasSaid) {
  EXPECT_THAT(all({event(opened, "", 0ms), event(received, "", 1ms, false, "FF"),
                   event(reset, "", 2ms, true)}),
              ElementsAre("> 49152 502 S 0 -", "< 502 49152 SA 0 1", "> 49152 502 A 1 1",
                          "< 502 49152 PA 1 1 FF", "< 502 49152 RA 2 1"));
  EXPECT_THAT(all({event(opened, "", 0ms), event(reset, "", 2ms)}),
              ElementsAre("> 49152 502 S 0 -", "< 502 49152 SA 0 1", "> 49152 502 A 1 1",
                          "> 49152 502 RA 1 1"));
}

TEST(CapturedNetwork, ARefusedConnectionNeverStood) {
  EXPECT_THAT(all({event(opened, "", 0ms), event(reset, "", 1ms, true)}),
              ElementsAre("> 49152 502 S 0 -", "< 502 49152 RA - 1"));
}

TEST(CapturedNetwork, LinksHaveTheirOwnPortsAndOrderIsThatOfTime) {
  EXPECT_THAT(all({event(opened, "a", 0ms), event(opened, "b", 1ms),
                   event(sent, "b", 2ms, false, "0B"), event(sent, "a", 3ms, false, "0A")}),
              ElementsAre("> 49152 502 S 0 -", "< 502 49152 SA 0 1", "> 49152 502 A 1 1",
                          "> 49153 502 S 0 -", "< 502 49153 SA 0 1", "> 49153 502 A 1 1",
                          "> 49153 502 PA 1 1 0B", "> 49152 502 PA 1 1 0A"));
}

TEST(CapturedNetwork, ANameMayBeOpenedAgainAndACaseBegunAnew) {
  const std::vector<Event> twice{event(opened, "a", 0ms), event(closed, "a", 1ms),
                                 event(opened, "a", 2ms), event(sent, "a", 3ms, false, "0A")};
  EXPECT_THAT(all(twice), testing::Contains("> 49153 502 PA 1 1 0A"));
  CapturedNetwork network;
  const auto comment = [](const Event&) { return std::string(); };
  network.packets(twice, comment);
  EXPECT_EQ(shown(network.packets(twice, comment).front()), "> 49154 502 S 0 -");
}

TEST(CapturedNetwork, TheDeviceOpensWhatItAsksOn) {
  EXPECT_THAT(all({event(opened, "", 0ms, true), event(received, "", 1ms, false, "01"),
                   event(sent, "", 2ms, false, "02"), event(closed, "", 3ms, true)}),
              ElementsAre("< 49152 502 S 0 -", "> 502 49152 SA 0 1", "< 49152 502 A 1 1",
                          "< 49152 502 PA 1 1 01", "> 502 49152 PA 1 2 02", "< 49152 502 FA 2 2",
                          "> 502 49152 A 2 3"));
}

/// What was not kept is a gap in the sequence: Wireshark says that the capture lacks it.
TEST(CapturedNetwork, OfAnExtractBothEndsAreThere) {
  Event flood = event(received, "", 1ms, false, "01 02");
  flood.extract = {1000, {0x08, 0x09, 0x0A}, ""};
  EXPECT_THAT(all({event(opened, "", 0ms), flood, event(received, "", 2ms, false, "0B")}),
              ElementsAre("> 49152 502 S 0 -", "< 502 49152 SA 0 1", "> 49152 502 A 1 1",
                          "< 502 49152 PA 1 1 01 02", "< 502 49152 PA 998 1 08 09 0A",
                          "< 502 49152 PA 1001 1 0B"));
}

TEST(CapturedNetwork, WhatNobodyHasOpenedTheBenchHas) {
  EXPECT_THAT(all({event(sent, "", 0ms, false, "01")}),
              ElementsAre("> 49152 502 S 0 -", "< 502 49152 SA 0 1", "> 49152 502 A 1 1",
                          "> 49152 502 PA 1 1 01"));
}

TEST(CapturedNetwork, DatagramsAreWholeAndMayBeEmpty) {
  EXPECT_THAT(all({datagram(opened, "a", ""), datagram(sent, "a", "01 02"), datagram(sent, "b", ""),
                   datagram(received, "a", "03"), datagram(closed, "a", "")}),
              ElementsAre("> 49152 2005 01 02", "> 49153 2005 ", "< 2005 49152 03"));
}

TEST(CapturedNetwork, LineEventsAndNotesAreNotOfIt) {
  Event line = event(sent, "", 0ms, false, "05");
  line.port = 0;
  EXPECT_THAT(all({line, event(note, "", 1ms)}), ElementsAre());
}

/// A sum over all words is FFFF where its checksum is right.
std::uint32_t folded(ByteView bytes) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < bytes.size(); i += 2)
    sum += bytes[i] * 256u + (i + 1 < bytes.size() ? bytes[i + 1] : 0u);
  while (sum >> 16) sum = (sum & 0xFFFF) + (sum >> 16);
  return sum;
}

TEST(IpPacket, ChecksumsAreRight) {
  for (const char* hex : {"", "01", "01 02 FF", "FF FF FF FF"}) {
    const Bytes payload = *from_hex(hex);
    const IpEnd from{0xC0000201, 49'152}, to{0xC0000202, 502};
    for (const Bytes& packet :
         {tcp_packet({from, to, 1, 2, tcp_ack, payload}, 7), udp_packet(from, to, payload, 7)}) {
      EXPECT_EQ(folded(ByteView(packet).first(20)), 0xFFFFu);
      const auto size = static_cast<unsigned>(packet.size() - 20);
      // Protocol and length of the pseudo header, its addresses, and the body.
      Bytes words{0, packet[9], static_cast<Byte>(size >> 8), static_cast<Byte>(size)};
      words.insert(words.end(), packet.begin() + 12, packet.end());
      EXPECT_EQ(folded(words), 0xFFFFu) << hex;
      EXPECT_EQ(packet[2] * 256u + packet[3], packet.size());
    }
  }
}

}  // namespace
}  // namespace fieldproof::reports
