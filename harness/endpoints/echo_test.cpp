#include "harness/endpoints/echo.hpp"

#include <gmock/gmock.h>

#include "harness/endpoints/kinds.hpp"
#include "harness/endpoints/test_endpoint_name.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::endpoints {
namespace {

using endpoints::test::endpoint_name;
using endpoints::test::NetworkProtocol;
using testing::ElementsAre;
using testing::HasSubstr;

class Filter : public testing::Test {
 protected:
  void send(const std::string& text) {
    now_ += 1ms;
    filter_.sent(to_bytes(text), now_);
  }
  /// One burst, each byte 1 ms.
  void come(const std::string& text) {
    filter_.take({to_bytes(text), now_, 1ms});
    now_ += 1ms * static_cast<Duration::rep>(text.size());
  }
  /// What is handed over so far: "text@start in ms".
  std::vector<std::string> rest() {
    std::vector<std::string> all;
    while (const std::optional<Burst> burst = filter_.next())
      all.push_back(to_text(burst->bytes) + '@' + std::to_string(burst->start / 1ms));
    return all;
  }

  EchoFilter filter_;
  Time now_{};
};

TEST_F(Filter, TakesOutWhatWasSentAndKeepsTheTimes) {
  send("<ask>");
  come("<ask><answer>");
  EXPECT_THAT(rest(), ElementsAre("<answer>@6"));
  EXPECT_EQ(filter_.take_troubles(), "");
}

TEST_F(Filter, AnEchoComesInPieces) {
  send("<ask>");
  for (const char* piece : {"<", "as", "k", "><an"}) come(piece);
  come("swer>");
  EXPECT_THAT(rest(), ElementsAre("<an@6", "swer>@9"));
}

TEST_F(Filter, AnEchoBeginsWhileTheRestIsStillSent) {
  send("<as");
  come("<a");
  send("k>");
  come("sk><answer>");
  EXPECT_THAT(rest(), ElementsAre("<answer>@7"));
  EXPECT_EQ(filter_.removed(), 2u);
}

TEST_F(Filter, AReplyThatEqualsTheRequestIsNoEcho) {
  send("<write>");
  come("<write><write>");
  EXPECT_THAT(rest(), ElementsAre("<write>@8"));
  come("<write>");
  EXPECT_THAT(rest(), ElementsAre("<write>@15")) << "each sending comes back once";
}

TEST_F(Filter, AnEchoThatDoesNotComeIsSaid) {
  send("<ask>");
  come("<answer>");
  EXPECT_THAT(rest(), ElementsAre("<answer>@1")) << "it begins as the request does";
  filter_.conclude(now_);
  EXPECT_EQ(filter_.take_troubles(), "1 missing or damaged echo (of 3C 61 73 6B 3E)");
  EXPECT_EQ(filter_.take_troubles(), "");
  EXPECT_EQ(filter_.removed(), 0u);
}

TEST_F(Filter, ADamagedEchoIsReceived) {
  send("<ask>");
  come("<aXk>");
  come("<answer>");
  EXPECT_THAT(rest(), ElementsAre("<aXk>@1", "<answer>@6"));
  send("<next>");
  come("<next><more>");
  EXPECT_THAT(rest(), ElementsAre("<more>@21")) << "the next echo is found";
  EXPECT_EQ(filter_.take_troubles(), "1 missing or damaged echo (of 3C 61 73 6B 3E)");
}

TEST_F(Filter, AnEchoThatEndsTooSoonIsReceivedOnceItIsOverdue) {
  send("<ask>");
  come("<as");
  filter_.expire(now_);
  EXPECT_TRUE(rest().empty()) << "it may go on";
  filter_.expire(now_ + EchoFilter::patience);
  EXPECT_THAT(rest(), ElementsAre("<as@1"));
  EXPECT_EQ(filter_.lost(), 1u);
}

TEST_F(Filter, WhatWasUnderWayBeforeIsNoEcho) {
  send("<ask>");
  come("<late><a");
  come("sk><answer>");
  EXPECT_THAT(rest(), ElementsAre("<late>@1", "<answer>@12"));
  EXPECT_EQ(filter_.lost(), 0u);
}

TEST_F(Filter, SendingsWithoutAPauseComeBackInTheirOrder) {
  send("<ask>");
  send("<ask>");
  come("<ask><1><ask><2>");
  EXPECT_THAT(rest(), ElementsAre("<1>@7", "<2>@15"));
}

TEST(EchoOption, IsForLines) {
  const harness::TestProtocol line;
  const auto objection = [](const EndpointName& name, const harness::Protocol& protocol) {
    const Status fits = check_endpoint(name, protocol);
    return fits ? "" : fits.error().message;
  };
  const std::map<std::string, std::string> on{{"echo", "on"}};
  EXPECT_EQ(objection(endpoint_name("exec", "x {tty}", on), line), "");
  EXPECT_EQ(objection(endpoint_name("tcp", "127.0.0.1:4001", on), line), "");
  EXPECT_THAT(objection(endpoint_name("tcp", "127.0.0.1:502", on), NetworkProtocol()),
              HasSubstr("leave echo=on out"));
  EXPECT_THAT(objection(endpoint_name("emulator", "xbc-h", on), line),
              HasSubstr("leave echo=on out"));
  EXPECT_THAT(objection(endpoint_name("exec", "x {tty}", {{"echo", "yes"}}), line),
              HasSubstr("echo is 'yes'; write echo=on"));
}

TEST(EchoOption, OneThatHearsItselfAndOneThatDoesNot) {
  const harness::TestProtocol line;
  const auto open = [&](const std::string& command) {
    Result<std::unique_ptr<Endpoint>> opened =
        open_endpoint(endpoint_name("exec", command, {{"echo", "on"}}), line);
    return opened ? std::move(*opened) : nullptr;
  };
  const auto echoing = open("while read x; do echo \"$x\"; echo \"<$x>\"; done");
  for (int i = 0; i < 20; ++i) {
    ASSERT_TRUE(echoing->send(to_bytes("ask\n")));
    ASSERT_EQ(os::test::receive_text(*echoing, ">\n"), "<ask>\n");
  }
  EXPECT_EQ(echoing->line_errors(), "");
  const auto mute = open("while read x; do echo \"<$x>\"; done");
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(mute->send(to_bytes("ask\n")));
    ASSERT_EQ(os::test::receive_text(*mute, ">\n"), "<ask>\n");
  }
  const Result<Sent> refused = mute->send(to_bytes("ask\n"));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("of 3 requests none has come back"));
}

}  // namespace
}  // namespace fieldproof::endpoints
