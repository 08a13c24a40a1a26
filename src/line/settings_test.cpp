#include "src/line/settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fieldproof::line {
namespace {

LineSettings read(std::string_view text) {
  const auto settings = parse_line_settings(text);
  EXPECT_TRUE(settings) << text << ": " << (settings ? "" : settings.error().message);
  return settings ? *settings : LineSettings{};
}

TEST(LineSettings, ASpeedAloneMeans8N1) {
  EXPECT_EQ(read("19200"), (LineSettings{19200, 8, 'N', 1}));
}

TEST(LineSettings, SpeedAndFormat) {
  EXPECT_EQ(read("9600-8N1"), (LineSettings{9600, 8, 'N', 1}));
  EXPECT_EQ(read("115200-7e2"), (LineSettings{115200, 7, 'E', 2}));
}

TEST(LineSettings, EverySettingOfTheManualSurvivesTheRoundTrip) {
  for (const int baud : {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200}) {
    for (const int data : {7, 8}) {
      for (const char parity : {'N', 'E', 'O'}) {
        for (const int stop : {1, 2}) {
          const LineSettings settings{baud, data, parity, stop};
          EXPECT_EQ(read(to_string(settings)), settings);
        }
      }
    }
  }
}

TEST(LineSettings, ErrorsNameTheWrongPart) {
  const auto message = [](std::string_view text) {
    const auto settings = parse_line_settings(text);
    return settings ? std::string("accepted") : settings.error().message;
  };
  EXPECT_THAT(message("9601-8N1"),
              ::testing::HasSubstr(
                  "cannot read line settings '9601-8N1': the speed is not one of the eight"));
  EXPECT_THAT(message(""), ::testing::HasSubstr("the speed"));
  EXPECT_THAT(message("fast"), ::testing::HasSubstr("the speed"));
  EXPECT_THAT(message("9600-9N1"), ::testing::HasSubstr("the data bits are not 7 or 8"));
  EXPECT_THAT(message("9600-8X1"), ::testing::HasSubstr("the parity is not N, E or O"));
  EXPECT_THAT(message("9600-8N3"), ::testing::HasSubstr("the stop bits are not 1 or 2"));
  EXPECT_THAT(message("9600-8N"), ::testing::HasSubstr("the character format is not DPS"));
  EXPECT_THAT(message("9600/8N1"), ::testing::HasSubstr("the character format is not DPS"));
}

TEST(LineSettings, BitsAndCharacterTimes) {
  EXPECT_EQ(read("9600-8N1").bits_per_character(), 10);
  EXPECT_EQ(read("9600-7N1").bits_per_character(), 9);
  EXPECT_EQ(read("9600-8E1").bits_per_character(), 11);
  EXPECT_EQ(read("9600-8O2").bits_per_character(), 12);
  EXPECT_EQ(read("1200-8E2").character_time(), 10ms);         // 12 bits of 1/1200 s
  EXPECT_EQ(read("9600-8N1").character_time(), 1'041'666ns);  // 10 bits of 104.1667 us
  EXPECT_EQ(read("115200-8N1").character_time(), 86'805ns);
}

}  // namespace
}  // namespace fieldproof::line
