#include "suites/email/protocol.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "suites/email/frame_parts.hpp"

namespace fieldproof::email_suite {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

std::optional<std::size_t> length(std::string_view text) { return frame_length(to_bytes(text)); }

std::vector<std::string> parts(std::string_view text) {
  std::vector<std::string> all;
  for (const harness::Field& field : explain(to_bytes(text)))
    all.push_back(field.name + '=' + field.text);
  return all;
}

TEST(EmailFrames, CommandsAndRepliesAreLines) {
  EXPECT_EQ(length("HELO a\r\nMAIL"), 8u);
  EXPECT_EQ(length("DATA\r\n"), 6u);
  EXPECT_EQ(length("250-a\r\n250 b\r\n"), 7u);
  EXPECT_EQ(length("QUIT\r"), std::nullopt);
  EXPECT_EQ(length(""), std::nullopt);
}

TEST(EmailFrames, ATextEndsWithADotAlone) {
  EXPECT_EQ(length("From: a\r\n\r\n..\r\n.\r\nQUIT\r\n"), 18u);
  EXPECT_EQ(length("From: a\r\n\r\n..\r\n"), std::nullopt);
  EXPECT_EQ(length(".\r\n"), 3u);
  EXPECT_EQ(length("DATABASE\r\n.\r\n"), 13u) << "no command";
}

TEST(EmailFrames, AreExplained) {
  EXPECT_THAT(parts("RCPT TO:<a@b>\r\n"),
              ElementsAre("command=RCPT", "argument= TO:<a@b>", "end of line=<0D><0A>"));
  EXPECT_THAT(parts("354 go\r\n"), ElementsAre("code=354", "words= go", "end of line=<0D><0A>"));
  EXPECT_THAT(parts("Subject: x\r\n\r\none\r\n\x80\r\n.\r\n"),
              ElementsAre("Subject=Subject: x<0D><0A>", "end of the header=<0D><0A>",
                          "line 1=one<0D><0A>", "line 2=<80><0D><0A>", "end=.<0D><0A>"));
  EXPECT_THAT(parts("no end"), ElementsAre("header line=no end"));
}

TEST(EmailFacts, SayWhatIsWrong) {
  const json p2p{{"email", {{"address", "a@b"}}}};
  EXPECT_TRUE(protocol().check_fact({{"parameter", p2p}, {"accepted", true}}));
  EXPECT_THAT(protocol().check_fact({{"parameter", p2p}, {"accepted", false}}).error().message,
              HasSubstr("is accepted"));
  const json wrong{{"email", {{"address", "a"}}}};
  EXPECT_THAT(protocol().check_fact({{"parameter", wrong}}).error().message,
              HasSubstr("it is refused: "));
  EXPECT_THAT(protocol()
                  .check_fact({{"parameter", wrong}, {"accepted", false}, {"says", "eleven"}})
                  .error()
                  .message,
              HasSubstr("without 'eleven'"));
}

}  // namespace
}  // namespace fieldproof::email_suite
