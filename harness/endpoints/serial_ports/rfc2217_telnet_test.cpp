#include "harness/endpoints/serial_ports/rfc2217_telnet.hpp"

#include <gmock/gmock.h>

namespace fieldproof::endpoints::telnet {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::string shown(const Message& message) {
  if (const Bytes* data = std::get_if<Bytes>(&message)) return "data " + to_hex(*data);
  if (const auto* notification = std::get_if<Notification>(&message))
    return "notify " + std::to_string(notification->command) + ' ' + to_hex(notification->value);
  const auto& negotiation = std::get<Negotiation>(message);
  const char* const verb = negotiation.verb == will    ? "will"
                           : negotiation.verb == wont  ? "wont"
                           : negotiation.verb == do_it ? "do"
                                                       : "dont";
  return std::string(verb) + ' ' + std::to_string(negotiation.option);
}

/// The messages of a stream, each part of it fed at once; data that stands together is shown
/// together.
std::vector<std::string> decoded(std::initializer_list<std::string_view> parts) {
  Decoder decoder;
  std::vector<std::string> shown_messages;
  Bytes data;
  const auto show_data = [&] {
    if (!data.empty()) shown_messages.push_back(shown(std::exchange(data, {})));
  };
  for (const std::string_view part : parts)
    for (const Message& message : decoder.decode(*from_hex(part))) {
      if (const Bytes* more = std::get_if<Bytes>(&message)) {
        data.insert(data.end(), more->begin(), more->end());
        continue;
      }
      show_data();
      shown_messages.push_back(shown(message));
    }
  show_data();
  return shown_messages;
}

TEST(Telnet, DoublesIacInData) {
  EXPECT_EQ(to_hex(escaped({{0x05, 0xFF, 0x00, 0xFF, 0xFF}})), "05 FF FF 00 FF FF FF FF");
  EXPECT_THAT(escaped({}), IsEmpty());
}

TEST(Telnet, CommandsAsInRfc2217) {
  EXPECT_EQ(to_hex(command(set_baud_rate, {{0x00, 0x00, 0x96, 0x00}})),
            "FF FA 2C 01 00 00 96 00 FF F0");
  EXPECT_EQ(to_hex(command(purge_data, {{purge_both}})), "FF FA 2C 0C 03 FF F0");
  EXPECT_EQ(to_hex(command(set_line_state_mask, {{0xFF}})), "FF FA 2C 0A FF FF FF F0")
      << "255 is doubled in a value, too";
  EXPECT_EQ(to_hex(negotiation(will, com_port)), "FF FB 2C");
}

TEST(Telnet, TakesDataNegotiationsAndNotificationsApart) {
  EXPECT_THAT(decoded({"41 FF FD 2C 42 FF FF FF FA 2C 65 00 00 96 00 FF F0 43"}),
              ElementsAre("data 41", "do 44", "data 42 FF", "notify 101 00 00 96 00", "data 43"));
  EXPECT_THAT(decoded({"FF FC 01 FF FE 00 FF FB 00"}), ElementsAre("wont 1", "dont 0", "will 0"));
  EXPECT_THAT(decoded({"FF FA 2C 6A FF FF FF F0"}), ElementsAre("notify 106 FF"));
}

TEST(Telnet, AStreamMayBeCutAnywhere) {
  const Bytes stream = *from_hex("41 FF FD 2C FF FF FF FA 2C 6A FF FF FF F0 0D 00");
  const std::string whole = to_hex(stream);
  const auto expected = decoded({whole});
  ASSERT_THAT(expected, ElementsAre("data 41", "do 44", "data FF", "notify 106 FF", "data 0D 00"));
  for (std::size_t cut = 1; cut < stream.size(); ++cut)
    EXPECT_EQ(decoded({std::string_view(whole).substr(0, cut * 3),
                       std::string_view(whole).substr(cut * 3)}),
              expected)
        << cut;
}

TEST(Telnet, WhatIsNotForUsIsPassedOver) {
  EXPECT_THAT(decoded({"41 FF F1 42"}), ElementsAre("data 41 42")) << "NOP";
  EXPECT_THAT(decoded({"FF FA 18 01 FF F0 41"}), ElementsAre("data 41"))
      << "the sub-negotiation of another option";
  EXPECT_THAT(decoded({"FF FA 2C FF F0 41"}), ElementsAre("data 41"))
      << "a notification without command";
  EXPECT_THAT(decoded({"FF FA 2C 65 FF F1 41"}), ElementsAre("data 41"))
      << "one that does not end as it must";
}

TEST(Negotiation, AgreesWhenBothDirectionsAreBinaryAndThePortObeys) {
  Negotiator negotiator;
  EXPECT_EQ(to_hex(Negotiator::opening()), "FF FB 00 FF FD 00 FF FB 03 FF FD 03 FF FB 2C");
  EXPECT_EQ(negotiator.missing(), "RFC 2217 (COM-PORT-OPTION)");
  EXPECT_THAT(negotiator.answer({do_it, com_port}), IsEmpty())
      << "an answer to our WILL is not answered";
  EXPECT_EQ(negotiator.missing(), "binary transmission");
  EXPECT_THAT(negotiator.answer({do_it, binary}), IsEmpty());
  EXPECT_EQ(negotiator.missing(), "binary transmission") << "one direction is not enough";
  EXPECT_THAT(negotiator.answer({will, binary}), IsEmpty());
  EXPECT_EQ(negotiator.missing(), "");
  EXPECT_EQ(negotiator.refused(), "");
}

TEST(Negotiation, RefusesWhatItDoesNotKnow) {
  Negotiator negotiator;
  EXPECT_EQ(to_hex(negotiator.answer({will, 1})), "FF FE 01");
  EXPECT_EQ(to_hex(negotiator.answer({do_it, 24})), "FF FC 18");
  EXPECT_EQ(to_hex(negotiator.answer({will, com_port})), "FF FE 2C") << "we are the client";
  EXPECT_THAT(negotiator.answer({dont, 1}), IsEmpty()) << "that is how it is already";
  EXPECT_THAT(negotiator.answer({wont, 24}), IsEmpty());
  EXPECT_EQ(negotiator.refused(), "");
}

TEST(Negotiation, ARefusalOfWhatIsNeededIsOne) {
  for (const telnet::Negotiation& one : std::initializer_list<telnet::Negotiation>{
           {dont, com_port}, {dont, binary}, {wont, binary}}) {
    Negotiator negotiator;
    negotiator.answer(one);
    EXPECT_EQ(negotiator.refused(),
              one.option == com_port ? "RFC 2217 (COM-PORT-OPTION)" : "binary transmission");
  }
  Negotiator negotiator;
  negotiator.answer({wont, suppress_go_ahead});
  EXPECT_EQ(negotiator.refused(), "") << "go-aheads are passed over";
}

}  // namespace
}  // namespace fieldproof::endpoints::telnet
