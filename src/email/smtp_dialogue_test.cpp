#include "src/email/smtp_dialogue.hpp"

#include <gmock/gmock.h>

#include "src/email/test_settings.hpp"

namespace fieldproof::email {
namespace {

using testing::ElementsAre;

Mail mail(unsigned address = 0) {
  return make_mail(*parse_email_settings(test::settings()), {0, address});
}

/// What is said to each of these, byte by byte.
std::vector<std::string> said(SmtpDialogue& dialogue, const std::vector<std::string>& heard) {
  std::vector<std::string> all;
  for (const std::string& one : heard) {
    std::string answer;
    for (const char c : one) answer += dialogue.hear(to_bytes(std::string(1, c)));
    all.push_back(answer);
  }
  return all;
}

TEST(SmtpDialogue, IsTheSameInAnyPieces) {
  SmtpDialogue dialogue(mail(9));
  EXPECT_THAT(said(dialogue, {"220-a\r\n220 b\r\n", "250-c\r\n250-d\r\n250 e\r\n", "250\r\n",
                              "251 f\r\n", "250 g\r\n", "354 h\r\n"}),
              ElementsAre("HELO plant.example\r\n", "MAIL FROM:<plc@plant.example>\r\n",
                          "RCPT TO:<peter@plant.example>\r\n", "RCPT TO:<tony@plant.example>\r\n",
                          "DATA\r\n", mail(9).content));
  EXPECT_FALSE(dialogue.result());
  EXPECT_THAT(said(dialogue, {"250 taken\r\n"}), ElementsAre("QUIT\r\n"));
  EXPECT_EQ(dialogue.result(), email_status::none);
  EXPECT_FALSE(dialogue.over());
  EXPECT_THAT(said(dialogue, {"221 bye\r\n", "250 what?\r\n"}), ElementsAre("", ""));
  EXPECT_TRUE(dialogue.over());
  EXPECT_EQ(dialogue.result(), email_status::none);
}

TEST(SmtpDialogue, TakesLinesThatEndWithLineFeedAlone) {
  SmtpDialogue dialogue(mail());
  EXPECT_THAT(said(dialogue, {"220 a\n"}), ElementsAre("HELO plant.example\r\n"));
}

TEST(SmtpDialogue, BreaksOffAtALineWithoutEnd) {
  SmtpDialogue dialogue(mail());
  EXPECT_EQ(dialogue.hear(to_bytes(std::string(2048, '2'))), "");
  EXPECT_FALSE(dialogue.over());
  EXPECT_EQ(dialogue.hear(to_bytes("2")), "");
  EXPECT_TRUE(dialogue.over());
  EXPECT_EQ(dialogue.result(), email_status::server);
}

TEST(SmtpDialogue, GivenUpBehindTheTextItIsTakenStill) {
  SmtpDialogue dialogue(mail());
  said(dialogue, {"220\r\n", "250\r\n", "250\r\n", "250\r\n", "354\r\n", "250\r\n"});
  dialogue.give_up();
  EXPECT_TRUE(dialogue.over());
  EXPECT_EQ(dialogue.result(), email_status::none);
}

TEST(Mail, HasQuotesWhereANameNeedsThem) {
  nlohmann::json settings = test::settings();
  settings["user"] = "The \"PLC\" \\ 1.2";
  const Mail one = make_mail(*parse_email_settings(settings), {0, 0});
  EXPECT_THAT(one.content,
              testing::StartsWith("From: \"The \\\"PLC\\\" \\\\ 1.2\" <plc@plant.example>\r\n"));
}

TEST(Mail, HasDotsForBytesThatCannotBePrinted) {
  const Mail one = make_mail(*parse_email_settings(test::settings()), {4, 0}, {{0x41, 0x0A, 0xFF}});
  EXPECT_THAT(one.content, testing::EndsWith("\r\n\r\nlevel A..\r\n.\r\n"));
}

}  // namespace
}  // namespace fieldproof::email
