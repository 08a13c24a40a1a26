#include "src/xnet_motion/omms.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xnet {
namespace {

Servo servo(nlohmann::json own) {
  const Result<Servo> read = read_servo(own);
  EXPECT_TRUE(read);
  return *read;
}

TEST(Omms, SlotsLieOneBehindTheOtherWithTheDataInTheirMiddle) {
  for (const unsigned axes : {1u, 10u, 20u}) {
    const auto slots = slots_of(servo({{"P7-05", axes}, {"P7-07", 6000}}), 30);
    ASSERT_TRUE(slots) << slots.error().message;
    ASSERT_EQ(slots->size(), axes);
    Duration end{};
    for (const Slot& one : *slots) {
      EXPECT_EQ(one.from, end);
      EXPECT_EQ(one.sends_from - one.from, one.to - one.sends_to);
      EXPECT_EQ(one.sends_to - one.sends_from, 110us);
      end = one.to;
    }
    EXPECT_EQ(end, axes * 165us);
  }
}

TEST(Omms, SlotsThatDoNotFitAndUnprintedFormatsAreErrors) {
  const auto message = [](const Servo& one) { return slots_of(one, 30).error().message; };
  EXPECT_EQ(message(servo({{"P7-05", 20}})),
            "20 slots of 45 characters take 3300 us, longer than P7-07 = 3000");
  EXPECT_EQ(message(servo({{"P7-01", "0x2206"}})),
            "P7-01 is 0x2206: only what 0x2213 means is printed");
  EXPECT_EQ(*sampling_time(servo(nlohmann::json::object())), 33us);
}

}  // namespace
}  // namespace fieldproof::xnet
