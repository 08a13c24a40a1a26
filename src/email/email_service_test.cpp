#include "src/email/email_service.hpp"

#include <gmock/gmock.h>

#include "src/email/email_plc.hpp"
#include "src/email/test_settings.hpp"
#include "src/net/network.hpp"

namespace fieldproof::email {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const json block{{"function", "esend"}, {"flag", "%MX0"}, {"message", 0}, {"to", 0}};

json config_of(const json& email, const json& blocks = json::array({block})) {
  return {{"role", "client"}, {"p2p", {{"email", email}, {"blocks", blocks}}}};
}

/// A PLC that mails by %MX0, and its server.
class Mailing : public testing::Test {
 protected:
  explicit Mailing(const json& changes = json::object()) {
    auto made = make_email_plc("xbc-h", config_of(test::with(test::settings(), changes)));
    if (!made) throw std::runtime_error(made.error().message);
    plc = std::move(*made);
    network.attach(*plc->network());
  }

  void pulse() {
    ASSERT_TRUE(plc->set("%MX0", "00"));
    ASSERT_TRUE(plc->set("%MX0", "01"));
  }
  /// "0:opened", "0:HELO plant.example", "0:closed" (link by its number among those of the PLC).
  std::string heard(Duration within = 0ms) {
    std::string all;
    for (const Time until = network.now() + within;;) {
      const Burst burst = network.receive(until);
      if (burst.bytes.empty() && burst.event == LinkEvent::data) return all;
      const std::string text = to_text(burst.bytes);
      all += (all.empty() ? "" : " ") + std::to_string(burst.link - first_own_link) + ":" +
             (burst.event == LinkEvent::opened   ? "opened"
              : burst.event == LinkEvent::closed ? "closed"
              : burst.event == LinkEvent::reset  ? "reset"
                                                 : text.substr(0, text.find_first_of(":\r")));
    }
  }
  void reply(unsigned link, std::string_view text) {
    ASSERT_TRUE(network.send(first_own_link + link, to_bytes(text)));
  }
  std::string result() { return *plc->get("%LW512", 0) + ' ' + *plc->get("%LW513", 0); }
  /// Up to the reply to the text.
  void mail_over(unsigned link) {
    for (const char* one :
         {"220 a\r\n", "250 b\r\n", "250 c\r\n", "250 d\r\n", "354 e\r\n", "250 f\r\n"}) {
      reply(link, one);
      (void)heard();
    }
  }

  std::unique_ptr<plc::EmulatedDevice> plc;
  net::SimulatedNetwork network;
};

class MailingElsewhere : public Mailing {
 protected:
  MailingElsewhere() : Mailing({{"server", "10.0.0.26"}, {"port", 2525}}) {}
};

TEST_F(MailingElsewhere, ConnectsToTheServerThatIsSet) {
  pulse();
  const Burst opened = network.receive(network.now());
  EXPECT_EQ(opened.event, LinkEvent::opened);
  EXPECT_EQ(opened.peer, "10.0.0.26");
  EXPECT_EQ(opened.port, 2525u);
}

TEST_F(Mailing, ARefusedConnectionIsAServerErrorAndTheNextEdgeTriesAgain) {
  network.take_connections(false);
  pulse();
  EXPECT_EQ(heard(1min), "");
  EXPECT_EQ(result(), "0002 0003");
  network.take_connections(true);
  pulse();
  EXPECT_EQ(heard(), "1:opened");
}

TEST_F(Mailing, WhatComesBehindItsEndIsAnsweredByRst) {
  pulse();
  (void)heard();
  mail_over(0);
  reply(0, "221 bye\r\n");
  EXPECT_EQ(heard(), "0:closed");
  reply(0, "250 more\r\n");
  EXPECT_EQ(heard(), "0:reset");
  EXPECT_EQ(result(), "0001 0000");
}

TEST_F(Mailing, OfWhatAServerLeavesOpenTheOldestIsReset) {
  std::string last;
  for (unsigned mail = 0; mail < 9; ++mail) {
    pulse();
    (void)heard();
    mail_over(mail);
    reply(mail, "221 bye\r\n");
    last = heard();
  }
  EXPECT_EQ(last, "8:closed 0:reset");
}

TEST_F(Mailing, AServerThatEndsFirstIsAnsweredByFin) {
  pulse();
  (void)heard();
  ASSERT_TRUE(network.close(first_own_link, Closing::fin));
  EXPECT_EQ(heard(10s), "0:closed");
  EXPECT_EQ(result(), "0002 0003");
}

TEST_F(Mailing, PowerIsLostWithoutAWord) {
  pulse();
  (void)heard();
  reply(0, "220 a\r\n");
  EXPECT_EQ(heard(), "0:HELO plant.example");
  ASSERT_TRUE(plc->act("power_cycle"));
  EXPECT_EQ(heard(1min), "");
  reply(0, "250 b\r\n");
  EXPECT_EQ(heard(), "0:reset");
  EXPECT_EQ(result(), "0000 0000");
  pulse();
  EXPECT_EQ(heard(), "1:opened");
}

TEST_F(Mailing, StopBehindTheTextSaysGoodByeAsUsual) {
  pulse();
  (void)heard();
  mail_over(0);
  ASSERT_TRUE(plc->act("stop"));
  EXPECT_EQ(heard(1s), "");
  reply(0, "221 bye\r\n");
  EXPECT_EQ(heard(), "0:closed");
  EXPECT_EQ(result(), "0001 0000");
}

TEST_F(Mailing, ActionsAreThoseOfTheLinkAndOfTheCpu) {
  for (const char* action : {"link off", "link on", "error on", "error off"})
    EXPECT_TRUE(plc->act(action)) << action;
  EXPECT_THAT(plc->act("eror off").error().message, HasSubstr("did you mean 'error off'"));
}

std::string refusal(const json& config) {
  const auto made = make_email_plc("xbc-h", config);
  return made ? "made" : made.error().message;
}

TEST(EmailPlc, ErrorsNameBlockAndKey) {
  const auto of_block = [](const json& changes) {
    return refusal(config_of(test::settings(), json::array({test::with(block, changes)})));
  };
  EXPECT_EQ(of_block(json::object()), "made");
  EXPECT_THAT(of_block({{"message", 1}}),
              HasSubstr("cannot set up P2P block 0: message is 1, and p2p.email.messages has none "
                        "of that number; it has 0, 4"));
  EXPECT_THAT(of_block({{"to", 5}}), HasSubstr("cannot set up P2P block 0: to is 5"));
  EXPECT_THAT(of_block({{"message", 4}}),
              HasSubstr("data has 0 addresses, and message 4 has 1 parts of the form mb"));
  EXPECT_THAT(of_block({{"data", "%MB0"}}), HasSubstr("data has 1 addresses, and message 0 has 0"));
  EXPECT_THAT(of_block({{"message", 4}, {"data", "%MB2046"}}),
              HasSubstr("the area ends before the last of 3 bytes"));
}

TEST(EmailPlc, MailsAlone) {
  EXPECT_EQ(refusal({{"station", 1}}), "made");
  EXPECT_THAT(refusal({{"p2p", {{"blocks", json::array()}}}}), HasSubstr("p2p"));
  const json read{{"flag", "%MX0"}, {"read", "%MW0"}, {"save", "%MW1"}};
  EXPECT_THAT(refusal(config_of(test::settings(), json::array({read}))),
              HasSubstr("cannot set up P2P block 0: it asks over a channel"));
  EXPECT_THAT(refusal({{"p2p", {{"blocks", json::array({read})}}}}),
              HasSubstr("there are no e-mail settings; give 'email'"));
  EXPECT_THAT(refusal({{"colour", 1}}), HasSubstr("there is no key 'colour'"));
}

}  // namespace
}  // namespace fieldproof::email
