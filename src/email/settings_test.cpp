#include "src/email/settings.hpp"

#include <gmock/gmock.h>

#include "src/email/test_settings.hpp"

namespace fieldproof::email {
namespace {

using nlohmann::json;
using test::settings;
using test::with;
using testing::ElementsAre;
using testing::Field;
using testing::HasSubstr;

EmailSettings parsed(const json& email) {
  const Result<EmailSettings> read = parse_email_settings(email);
  EXPECT_TRUE(read) << (read ? "" : read.error().message);
  return read ? *read : EmailSettings{};
}
std::string error_of(const json& email) {
  const Result<EmailSettings> read = parse_email_settings(email);
  return read ? "" : read.error().message;
}
/// One more entry of a list.
json and_one(const char* list, const json& entry) {
  json email = settings();
  email[list].push_back(entry);
  return email;
}
json part(const json& one) {
  return and_one("messages", {{"title", "T"}, {"parts", json::array({one})}});
}
json event(const char* name, const json& mail) {
  return with(settings(), {{"events", {{name, mail}}}});
}

TEST(EmailSettings, HaveAnAddressBookAndMessages) {
  const EmailSettings email = parsed(settings());
  EXPECT_TRUE(email.use);
  EXPECT_EQ(email.port, 25u);
  EXPECT_EQ(email.period, 10s);
  EXPECT_EQ(numbers_of(email.addresses), "0, 1, 9");
  EXPECT_THAT(email.addresses.at(9),
              ElementsAre(Field(&Mailbox::name, "Peter"), Field(&Mailbox::name, "Tony")));
  EXPECT_EQ(numbers_of(email.messages), "0, 4");
  EXPECT_EQ(email.messages.at(4).memory_parts(), 1u);
  EXPECT_FALSE(email.messages.at(4).parts[1].change);
}

TEST(EmailSettings, KnowWhatIsNotUsed) {
  const EmailSettings email = parsed(with(settings(), {{"pop3_server", "10.0.0.9"},
                                                       {"account", "plc"},
                                                       {"password", "secret"},
                                                       {"interval_s", 60},
                                                       {"use", false},
                                                       {"port", 2525},
                                                       {"period_s", 3600}}));
  EXPECT_FALSE(email.use);
  EXPECT_EQ(email.port, 2525u);
  EXPECT_EQ(email.period, 1h);
}

TEST(EmailSettings, ItsServerIsAHost) {
  for (const char* key : {"server", "pop3_server"}) {
    const auto wrong = parse_email_settings(with(settings(), {{key, "300.1.1.1"}}));
    ASSERT_FALSE(wrong) << key;
    EXPECT_THAT(wrong.error().message, testing::HasSubstr(std::string("cannot read p2p.email: ") +
                                                          key + " is \"300.1.1.1\""));
  }
}

TEST(EmailSettings, EventsHaveNumbersOfTheirOwn) {
  const EmailSettings email = parsed(event("stop_to_run", {{"message", 0}, {"to", 9}}));
  ASSERT_TRUE(email.events[static_cast<std::size_t>(CpuEvent::stop_to_run)]);
  EXPECT_EQ(email.events[1]->address, 9u);
  EXPECT_FALSE(email.events[0] || email.events[2]);
}

TEST(EmailSettings, AGroupMayStandBeforeItsMembers) {
  const EmailSettings email = parsed(with(
      settings(),
      {{"addresses", {{{"number", 7}, {"group", {3}}}, {{"number", 3}, {"address", "a@b"}}}}}));
  EXPECT_THAT(email.addresses.at(7), ElementsAre(Field(&Mailbox::address, "a@b")));
}

TEST(EmailSettings, ErrorsNameTheKey) {
  const std::vector<std::pair<json, std::string>> errors{
      {with(settings(), {{"colour", 1}}), "cannot read p2p.email: there is no key 'colour'"},
      {json::array(), "cannot read p2p.email: it is not a JSON object"},
      {with(settings(), {{"address", "plc"}}), "cannot read p2p.email: address is 'plc'"},
      {with(settings(), {{"address", "a@b@c"}}), "address is 'a@b@c'"},
      {with(settings(), {{"address", "plc @b"}}), "address is 'plc @b'"},
      {with(settings(), {{"user", "W\u00e4rter"}}), "user has a character that is no printable"},
      {with(settings(), {{"user", std::string(65, 'a')}}), "user has 65 characters"},
      {with(settings(), {{"port", 0}}), "port is 0; leave it out for 25"},
      {with(settings(), {{"port", 65536}}), "port is 65536"},
      {with(settings(), {{"period_s", 9}}), "period_s is 9; give at least 10 s"},
      {with(settings(), {{"addresses", 3}}), "addresses is no list"},
      {with(settings(), {{"use", 3}}), "use is 3"},
  };
  for (const auto& [email, error] : errors) EXPECT_THAT(error_of(email), HasSubstr(error));
}

TEST(EmailSettings, ErrorsOfTheAddressBookNameTheEntry) {
  const std::vector<std::pair<json, std::string>> errors{
      {{{"address", "no"}}, "cannot read p2p.email.addresses[3]: address is 'no'"},
      {{{"number", 1}, {"address", "a@b"}}, "addresses[3]: number 1 is there twice"},
      {{{"name", "Both"}, {"address", "a@b"}, {"group", {0}}}, "give address, of one person, or"},
      {{{"name", "None"}}, "give address, of one person, or"},
      {{{"group", json::array()}}, "group is no list of numbers"},
      {{{"group", {0, 5}}}, "group has 5, and there is no such address; there are 0, 1, 3, 9"},
      {{{"group", {0, 9}}}, "group has 9, which is a group itself"},
      {{{"group", {0, 0}}}, "group has 0 twice"},
      {{{"group", {-1}}}, "group has -1, which is no number"},
      {{{"group", {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}},
       "group has 11 members; a group has at most "
       "10 (FEnet EN 7.4.3)"},
      {{{"adress", "a@b"}}, "did you mean 'address'"}};
  for (const auto& [entry, error] : errors)
    EXPECT_THAT(error_of(and_one("addresses", entry)), HasSubstr(error));
}

TEST(EmailSettings, APlaceBehindTheNumbersIsNone) {
  json email = settings();
  email["messages"] = json(257, json{{"title", "T"}});
  EXPECT_THAT(error_of(email), HasSubstr("it has the number 256 by its place"));
}

TEST(EmailSettings, ErrorsOfMessagesNameTheEntry) {
  EXPECT_THAT(error_of(part({{"text", "a"}, {"mb", 1}})),
              HasSubstr("cannot read p2p.email.messages[2].parts[0]: give text, a string, or mb"));
  EXPECT_THAT(error_of(part({{"mb", 0}})), HasSubstr("mb is 0; give at least 1"));
  EXPECT_THAT(error_of(part({{"mb", 999}})), HasSubstr("mb is 999"));
  EXPECT_THAT(error_of(part({{"text", "a\nb"}})), HasSubstr("ASCII alone (FEnet EN 7.4.1)"));
  EXPECT_THAT(error_of(and_one("messages", {{"number", 4}})), HasSubstr("number 4 is there twice"));
  EXPECT_THAT(error_of(and_one("messages", {{"parts", 1}})), HasSubstr("parts is no list"));
  const json long_line{{"text", std::string(600, 'a')}};
  EXPECT_THAT(error_of(and_one("messages", {{"parts", {long_line, long_line}}})),
              HasSubstr("a line of more than 998 characters"));
  const json byte{{"mb", 1}};
  EXPECT_THAT(error_of(and_one("messages", {{"parts", {byte, byte, byte, byte, byte}}})),
              HasSubstr("parts has 5 of the form mb; a block has at most 4"));
}

TEST(EmailSettings, ErrorsOfEventsNameTheEvent) {
  EXPECT_THAT(error_of(event("run_to_halt", {})), HasSubstr("there is no key 'run_to_halt'"));
  EXPECT_THAT(error_of(event("error", {{"message", 0}})),
              HasSubstr("cannot read p2p.email.events.error: there is no to"));
  EXPECT_THAT(error_of(event("error", {{"message", 2}, {"to", 0}})),
              HasSubstr("events.error: message is 2, and p2p.email.messages has none"));
  EXPECT_THAT(
      error_of(event("error", {{"message", 0}, {"to", 3}})),
      HasSubstr("to is 3, and p2p.email.addresses has none of that number; it has 0, 1, 9"));
  EXPECT_THAT(error_of(event("error", {{"message", 4}, {"to", 0}})),
              HasSubstr("message 4 has parts of the form mb, and an event has no data"));
}

}  // namespace
}  // namespace fieldproof::email
