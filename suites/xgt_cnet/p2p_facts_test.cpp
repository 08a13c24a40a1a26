#include "suites/xgt_cnet/p2p_facts.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xgt_cnet_suite {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string problem(const char* facts) {
  const Status status = check_p2p_fact(json::parse(facts));
  return status ? "" : status.error().message;
}

// Cnet EN and KO Appendix 2.1 (3), 2.2
TEST(P2pFacts, WhatIsPrinted) {
  EXPECT_EQ(problem(R"({"p2p": 1, "block": 0, "flag": "ndr", "mk": "L5120", "iec": "%LX8192"})"),
            "");
  EXPECT_EQ(
      problem(R"({"p2p": "2", "block": "0", "flag": "err", "mk": "L07041", "iec": "%LX11265"})"),
      "");
  EXPECT_EQ(problem(R"({"p2p": 1, "block": 0, "flag": "errors", "mk": "L516", "iec": "%LD258"})"),
            "");
  EXPECT_EQ(
      problem(
          R"({"p2p": 1, "block": 2, "flag": "all", "mk": "L524~L529", "iec": "%LW524 ~ %LW529"})"),
      "");
  EXPECT_EQ(
      problem(R"({"p2p": 1, "block": 4, "last_block": 30, "flag": "all", "mk": "L536~L697"})"), "");
  EXPECT_EQ(
      problem(R"({"p2p": 1, "block": 0, "register": "station", "mk": "N000", "iec": "%NW000"})"),
      "");
  EXPECT_EQ(
      problem(
          R"({"p2p": 1, "block": 0, "register": "save 4", "mk": "N0036~0039", "iec": "%NW0043 ~0047"})"),
      "");
  EXPECT_EQ(
      problem(
          R"({"p2p": 3, "block": 0, "last_block": 31, "register": "all", "mk": "N2624~3935", "iec": "%NW3136 ~4703"})"),
      "");
}

TEST(P2pFacts, WhatIsWrong) {
  EXPECT_EQ(problem(R"({"p2p": 1, "block": 1, "flag": "errors", "mk": "L522", "iec": "%LD264"})"),
            "errors of P2P 1 block 1: the table has %LD261, the manual %LD264");
  EXPECT_THAT(problem(R"({"p2p": 1, "block": 0, "register": "read 1", "mk": "N0000~0004"})"),
              HasSubstr("has N1~4, the manual N0000~0004"));
  EXPECT_THAT(problem(R"({"p2p": 1, "block": 0, "flag": "ndr", "mk": "L512"})"),
              HasSubstr("has L5120"));
  EXPECT_THAT(problem(R"({"p2p": 1, "block": 0, "flag": "colour", "mk": "L5120"})"),
              HasSubstr("has no flag 'colour'"));
  EXPECT_THAT(problem(R"({"p2p": 1, "block": 32, "flag": "ndr", "mk": "L5120"})"),
              HasSubstr("block"));
  EXPECT_THAT(
      problem(R"({"p2p": 1, "block": 0, "flag": "ndr", "register": "station", "mk": "L5120"})"),
      HasSubstr("flag or register"));
  EXPECT_THAT(problem(R"({"p2p": 1, "block": 0, "flag": "ndr"})"), HasSubstr("mk or iec"));
}

}  // namespace
}  // namespace fieldproof::xgt_cnet_suite
