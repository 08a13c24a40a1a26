#include "reports/text/remedy.hpp"

#include <gmock/gmock.h>

namespace fieldproof::text {
namespace {

using testing::HasSubstr;

TEST(Remedy, NamesTheOption) {
  EXPECT_THAT(remedy_of("writes %MW1; allow it with --allow-write M1"),
              HasSubstr("--allow-write RANGES"));
  EXPECT_THAT(remedy_of("needs a device fresh from power-on; give --power-cycle COMMAND"),
              HasSubstr("--power-cycle COMMAND"));
}

TEST(Remedy, ReasonsThatTheSameEndsHaveTheSame) {
  EXPECT_EQ(remedy_of("cannot set %FW0: %FW0 is read only over the protocol"),
            remedy_of("cannot set %NW10: %NW10 is read only over the protocol"));
  EXPECT_EQ(remedy_of("needs delay_ms = 50; the profile declares 0"),
            remedy_of("needs inter_character_ms = 10; the profile declares nothing"));
  EXPECT_NE(remedy_of("is about station 31; the device is station 1"),
            remedy_of("needs delay_ms = 50; the profile declares 0"));
}

TEST(Remedy, ASecondLineTakesAWire) {
  EXPECT_THAT(remedy_of("needs a second line to the same device, which the bench has not: services "
                        "= {\"modbus-rtu\":{\"station\":3}}"),
              HasSubstr("a wire of its own"));
}

TEST(Remedy, AnUnknownReasonStandsForItselfWithoutItsValues) {
  EXPECT_EQ(remedy_of("the moon is at 17 degrees"), "the moon is at # degrees");
  EXPECT_EQ(remedy_of("the bench's own clock has stopped"), "the bench's own clock has stopped");
  EXPECT_EQ(remedy_of(""), "no reason given");
}

}  // namespace
}  // namespace fieldproof::text
