#include "reports/history/storage/packed_list.hpp"

#include <gmock/gmock.h>

namespace fieldproof::history {
namespace {

using testing::ElementsAre;
using testing::Optional;

TEST(PackedList, ComesBackAsItWas) {
  Numbers powers{0};
  for (std::int64_t power = 1; power < std::int64_t{1} << 61; power *= 2)
    for (const std::int64_t near : {power - 1, power, power + 1})
      powers.insert(powers.end(), {near, -near});
  for (const Numbers& numbers : {Numbers{}, Numbers{7}, Numbers{7, 7, 7, -7, 0, 0}, powers}) {
    EXPECT_THAT(unpack(pack(numbers)), Optional(numbers));
    EXPECT_EQ(from_steps(to_steps(numbers)), numbers);
  }
}

TEST(PackedList, EqualNeighboursCostNothing) {
  EXPECT_LE(pack(Numbers(10'000, 1)).size(), 4u);
  Numbers rising(10'000);
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = static_cast<std::int64_t>(i) + 5;
  EXPECT_LE(pack(to_steps(rising)).size(), 6u);
  EXPECT_EQ(pack({3}), "\x0C") << "one byte for a small number";
}

TEST(PackedList, ReadsWithoutSpellingOut) {
  const auto parts = unpack_repeated(pack({7, 7, 7, -2, 7}));
  ASSERT_TRUE(parts);
  std::vector<std::pair<std::int64_t, std::size_t>> found;
  for (const Repeated& one : *parts) found.emplace_back(one.number, one.count);
  EXPECT_THAT(found, ElementsAre(testing::Pair(7, 3), testing::Pair(-2, 1), testing::Pair(7, 1)));
}

TEST(PackedList, RefusesWhatNobodyPacked) {
  EXPECT_EQ(unpack("\x80"), std::nullopt) << "its number goes on";
  EXPECT_EQ(unpack("\x03"), std::nullopt) << "the count is missing";
  EXPECT_EQ(unpack("\x03\xFF\xFF\xFF\xFF\x7F"), std::nullopt) << "no run has so many cases";
  EXPECT_EQ(unpack(std::string(11, '\xFF')), std::nullopt);
}

}  // namespace
}  // namespace fieldproof::history
