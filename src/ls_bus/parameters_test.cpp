#include "src/ls_bus/parameters.hpp"

#include <gmock/gmock.h>

namespace fieldproof::ls_bus {
namespace {

TEST(InverterParameters, EndsOfTheRanges) {
  const InverterParameters parameters;
  for (const unsigned address : {0x0000u, 0x0FFFu, 0x1200u, 0x12FFu})
    EXPECT_TRUE(parameters.exist(address, 1)) << std::hex << address;
  for (const unsigned address : {0x1000u, 0x11FFu, 0x1300u, 0xFFFFu, 0x10000u})
    EXPECT_FALSE(parameters.exist(address, 1)) << std::hex << address;
}

TEST(InverterParameters, ARunExistsAsAWhole) {
  const InverterParameters parameters;
  EXPECT_TRUE(parameters.exist(0x0FF8, 8));
  EXPECT_FALSE(parameters.exist(0x0FF9, 8));
  EXPECT_TRUE(parameters.exist(0x12F8, 8));
  EXPECT_FALSE(parameters.exist(0x11FF, 2));
  EXPECT_FALSE(parameters.exist(0xFFFF, 2));
}

TEST(InverterParameters, ReadOnlyAtBothEnds) {
  const InverterParameters parameters;
  for (const unsigned address : {0x0000u, 0x0003u, 0x0009u, 0x000Fu, 0x1000u})
    EXPECT_FALSE(parameters.writable(address, 1)) << std::hex << address;
  for (const unsigned address : {0x0004u, 0x0008u, 0x0010u, 0x0FFFu, 0x1200u, 0x12FFu})
    EXPECT_TRUE(parameters.writable(address, 1)) << std::hex << address;
  EXPECT_TRUE(parameters.writable(0x0004, 5));
  EXPECT_FALSE(parameters.writable(0x0004, 6));
  EXPECT_FALSE(parameters.writable(0x0003, 2));
}

TEST(InverterParameters, WordsAreZeroAndThenWhatWasWritten) {
  InverterParameters parameters;
  EXPECT_EQ(parameters.read(0x1230), 0);
  parameters.write(0x1230, 0xA55A);
  EXPECT_EQ(parameters.read(0x1230), 0xA55A);
  EXPECT_EQ(parameters.read(0x1231), 0);
}

}  // namespace
}  // namespace fieldproof::ls_bus
