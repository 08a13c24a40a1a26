#include "src/udata/modem.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::udata {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Wired {
 public:
  explicit Wired(const json& config = json::object()) {
    auto made = make_modem(config);
    if (!made) throw std::runtime_error(made.error().message);
    modem = std::move(*made);
  }

  /// What comes back at once.
  std::string say(std::string_view text) {
    modem->line()->receive({to_bytes(text), now_, character});
    now_ += character * static_cast<Duration::rep>(text.size());
    return hear({});
  }
  /// What comes within a time.
  std::string hear(Duration patience) {
    Bytes out;
    const Time until = now_ + patience;
    for (auto wake = modem->line()->wake_at(); wake && *wake <= until;
         wake = modem->line()->wake_at()) {
      const Bytes part = modem->line()->advance(std::max(*wake, now_));
      out.insert(out.end(), part.begin(), part.end());
    }
    now_ = until;
    modem->line()->advance(now_);
    return to_text(out);
  }

  std::unique_ptr<plc::EmulatedDevice> modem;

 private:
  static constexpr Duration character = 87us;  // 115200-8N1, as the table of 11.5 has it
  Time now_{};
};

TEST(Modem, AnswersOkToACommandThatHasArrived) {
  Wired one;
  EXPECT_EQ(one.say("AT"), "");
  EXPECT_EQ(one.say("\r"), "OK");
  EXPECT_EQ(one.say("AT+CRM=129\r"), "OK");
  EXPECT_EQ(*one.modem->get("@services", 0), "0002");
}

TEST(Modem, SaysNothingToWhatIsNoCommand) {
  Wired one;
  EXPECT_EQ(one.say("0123456789\r"), "");
  EXPECT_EQ(*one.modem->get("@errors", 0), "0001");
  EXPECT_EQ(one.say("AT\r"), "OK");
}

TEST(Modem, PassesDataOnceConnected) {
  Wired one;
  EXPECT_FALSE(one.modem->act("deliver 1"));
  EXPECT_EQ(one.say("ATDT01094714031\r"), "CONNECT");
  EXPECT_EQ(one.say("0123456789"), "");
  EXPECT_EQ(one.say("AT\r"), "") << "data as well";
  EXPECT_EQ(*one.modem->get("@data", 26), "3031323334353637383941540D");
  ASSERT_TRUE(one.modem->act("deliver 0123456789"));
  EXPECT_EQ(one.hear({}), "0123456789");
  ASSERT_TRUE(one.modem->act("power_cycle"));
  EXPECT_EQ(one.say("AT\r"), "OK");
}

TEST(Modem, Bsm856rReportsAnSmsWith006) {
  Wired one(json{{"sms", "AT*SMS"}});
  EXPECT_EQ(one.say("AT*SMS 48656C6C6F\r"), "OK");
  EXPECT_EQ(one.hear(500ms), "");
  EXPECT_EQ(one.say("AT\r"), "OK");
  EXPECT_EQ(one.hear(500ms), "$006");
  ASSERT_TRUE(one.modem->set("@network", "00"));
  EXPECT_EQ(one.say("AT*SMS 48656C6C6F\r"), "OK");
  EXPECT_EQ(one.hear(10s), "");
}

TEST(Modem, Rcu890ReportsAnSmsWithMoack) {
  Wired one(json{{"modem", "rcu-890"}, {"sms", "AT*SMS"}, {"network_ms", 200}});
  EXPECT_EQ(one.say("AT*SMS TESTMSG\r"), "*SKT*PRIMO:0OK");
  EXPECT_EQ(one.hear(200ms), "*SKT*MOACK:0,1");
  ASSERT_TRUE(one.modem->set("@network", "00"));
  one.say("AT*SMS TESTMSG\r");
  EXPECT_EQ(one.hear(200ms), "*SKT*MOACK:0,0");
  EXPECT_EQ(one.say("ATDT1\r"), "OK") << "the manual dials with the other modem";
}

TEST(Modem, EndsItsAnswersWhereToldTo) {
  Wired one(json{{"modem", "rcu-890"}, {"sms", "AT*SMS"}, {"reply_end", "\r\n"}});
  EXPECT_EQ(one.say("AT*SMS TESTMSG\r"), "*SKT*PRIMO:0\r\nOK\r\n");
}

TEST(Modem, NeedsDtrAndRts) {
  for (const char* wire : {"@dtr", "@rts"}) {
    Wired one(json{{wire + 1, false}});
    EXPECT_EQ(one.say("AT\r"), "");
    EXPECT_EQ(*one.modem->get(wire, 0), "00");
    ASSERT_TRUE(one.modem->set(wire, "01"));
    EXPECT_EQ(one.say("AT\r"), "OK");
  }
}

TEST(Modem, RefusesWhatItDoesNotKnow) {
  const auto typo = make_modem(json{{"modem", "bsm-856"}});
  ASSERT_FALSE(typo);
  EXPECT_THAT(typo.error().message,
              HasSubstr("modem is 'bsm-856', which is not rcu-890 or bsm-856r"));
  Wired one;
  EXPECT_THAT(one.modem->set("%MW0", "0000").error().message, HasSubstr("a modem has no memory"));
  EXPECT_THAT(one.modem->act("stop").error().message, HasSubstr("power_cycle or deliver TEXT"));
}

}  // namespace
}  // namespace fieldproof::udata
