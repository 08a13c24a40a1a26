#include "harness/exchange/memory_runs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "harness/test_protocol.hpp"

namespace fieldproof::exchange {
namespace {

using testing::ElementsAre;

std::vector<std::string> spelled(const MemoryValues& values) {
  std::vector<std::string> all;
  for (const MemoryRun run : runs_of(values, harness::TestProtocol())) {
    const auto [address, hex] = as_one(run);
    all.push_back(address + "=" + hex + "/" + std::to_string(run.size()));
  }
  return all;
}

TEST(MemoryRuns, AreWordsThatFollowEachOther) {
  EXPECT_THAT(spelled({{"%MW1", "0001"}, {"%MW2", "0002"}, {"%MW3", "0003"}, {"%MW5", "0005"}}),
              ElementsAre("%MW1=000100020003/3", "%MW5=0005/1"));
}

TEST(MemoryRuns, KeepTheOrderOfTheValues) {
  EXPECT_THAT(spelled({{"%MW2", "0002"}, {"%MW1", "0001"}, {"%MW2", "0003"}}),
              ElementsAre("%MW2=0002/1", "%MW1=00010003/2"));
}

TEST(MemoryRuns, EndWithTheirArea) {
  EXPECT_THAT(spelled({{"%MW1", "0001"}, {"%DW2", "0002"}}),
              ElementsAre("%MW1=0001/1", "%DW2=0002/1"));
}

/// Whatever is no single word under its usual name stays as it is.
TEST(MemoryRuns, LeaveOtherSpellingsAlone) {
  EXPECT_THAT(spelled({{"%MB2", "0001"}, {"%MB4", "0002"}}),
              ElementsAre("%MB2=0001/1", "%MB4=0002/1"));
  EXPECT_THAT(spelled({{"%MX16", "01"}, {"%MX17", "01"}}), ElementsAre("%MX16=01/1", "%MX17=01/1"));
  EXPECT_THAT(spelled({{"%MW1", "00010002"}, {"%MW3", "0003"}}),
              ElementsAre("%MW1=00010002/1", "%MW3=0003/1"));
  EXPECT_THAT(spelled({{"B:%MW1", "0001"}, {"B:%MW2", "0002"}}),
              ElementsAre("B:%MW1=0001/1", "B:%MW2=0002/1"));
}

}  // namespace
}  // namespace fieldproof::exchange
