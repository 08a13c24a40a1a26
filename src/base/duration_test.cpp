#include "src/base/duration.hpp"

#include <gtest/gtest.h>

namespace fieldproof {
namespace {

TEST(Duration, ReadsNumberAndUnit) {
  EXPECT_EQ(500us, *parse_duration("500us"));
  EXPECT_EQ(20ms, *parse_duration("20ms"));
  EXPECT_EQ(1500ms, *parse_duration("1.5s"));
  EXPECT_EQ(10min, *parse_duration("10m"));
  EXPECT_EQ(8h, *parse_duration("8h"));
  EXPECT_EQ(0ns, *parse_duration("0s"));
}

TEST(Duration, RefusesWhatIsNone) {
  for (const char* text :
       {"", "5", "ms", "-1s", "1 s", "1d", "5msx", "1e3s", "nan", "inf s", "99999999999h"}) {
    const Result<Duration> read = parse_duration(text);
    ASSERT_FALSE(read) << text;
    EXPECT_EQ("'" + std::string(text) + "' is no duration; write 500us, 20ms, 1s, 10m or 8h",
              read.error().message);
  }
}

}  // namespace
}  // namespace fieldproof
