#include "harness/exchange/p2p_blocks.hpp"

#include <gmock/gmock.h>

namespace fieldproof::exchange {
namespace {

using nlohmann::json;

TEST(P2pBlocks, EveryDefaultIsWrittenOut) {
  const auto blocks = p2p_blocks(json::parse(R"({"p2p": {"parameter": 2, "blocks": [
    {"flag": "%mx00000", "read": "%MW100", "save": "%MW200", "station": "2"}, {"function": "receive", "frame": "A.B"}]}})"));
  ASSERT_EQ(blocks.size(), 2u);
  EXPECT_EQ(
      blocks[0],
      json::parse(
          R"({"parameter": 2, "block": 0, "channel": 1, "function": "read", "command": "single", "type": "word", "size": 1,
    "flag": "%MX00000", "read": ["%MW100"], "save": ["%MW200"], "station": 2})"));
  EXPECT_EQ(
      blocks[1],
      json::parse(
          R"({"parameter": 2, "block": 1, "channel": 1, "function": "receive", "frame": "A.B"})"));
  EXPECT_TRUE(p2p_blocks(json::object()).empty());
}

TEST(P2pBlocks, ClocksAreWhatNobodySets) {
  for (const char* flag : {"F92", "_T200MS", "%FX00920"})
    EXPECT_TRUE(runs_by_clock({{"flag", flag}})) << flag;
  for (const char* flag : {"%MX00000", ""}) EXPECT_FALSE(runs_by_clock({{"flag", flag}})) << flag;
}

TEST(P2pBlocks, OnlyWritesSendMemory) {
  EXPECT_THAT(sent_addresses({{"function", "write"}, {"read", {"%MW1", "%MW2"}}}),
              testing::ElementsAre("%MW1", "%MW2"));
  EXPECT_TRUE(sent_addresses({{"function", "read"}, {"read", {"%MW1"}}}).empty());
}

TEST(P2pBlocks, AnEngineerCanSetThemUpFromTheWords) {
  const json read = complete_blocks(json::parse(
      R"([{"block": 3, "flag": "F92", "command": "continuous", "size": 4, "read": "%MW100", "save": "%MW200", "station": 2}])"))
      [0];
  EXPECT_EQ(in_words(read, "xgt-cnet"),
            "P2P 1 block 3: xgt-cnet client, channel 1, read, continuous, 4 x word, on F92, from "
            "%MW100 of station 2, into %MW200");
}

/// An inverter's address keeps its four digits: it is no number.
TEST(P2pBlocks, AddressesStayTextAsTheyAreSpelled) {
  const json block = complete_blocks(
      json::parse(R"([{"read": "0100", "save": "%MW1", "size": "4", "station": "2"}])"))[0];
  EXPECT_EQ(block["read"], json::parse(R"(["0100"])"));
  EXPECT_EQ(block["size"], 4);
  EXPECT_EQ(block["station"], 2);
}

TEST(P2pBlocks, WhatIsPreparedOtherwiseIsNamedByItsKeys) {
  const auto blocks = complete_blocks(json::parse(R"([{"read": "%MW1", "station": 2}])"));
  const auto other =
      complete_blocks(json::parse(R"([{"read": "%MW1", "station": 3, "type": "byte"}])"));
  EXPECT_EQ(not_prepared(blocks, blocks, "xgt-cnet"), "");
  EXPECT_THAT(not_prepared(blocks, other, "xgt-cnet"),
              testing::EndsWith("(listed there is another: station is 3, 2 is needed; type is "
                                "\"byte\", \"word\" is needed)"));
  EXPECT_THAT(not_prepared(blocks, {}, "xgt-cnet"), testing::EndsWith("of station 2, into ?"));
}

TEST(P2pBlocks, AMailInWordsHasNoChannel) {
  const auto blocks = complete_blocks(json::parse(
      R"([{"function": "esend", "flag": "%MX0", "message": 1, "to": 2, "data": "%MB9"}])"));
  EXPECT_EQ(in_words(blocks.at(0), "smtp"),
            "P2P 1 block 0: smtp client, esend, on %MX0, message 1 to address 2, data %MB9");
}

}  // namespace
}  // namespace fieldproof::exchange
