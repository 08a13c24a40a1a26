#include "reports/results/section_titles.hpp"

#include <gtest/gtest.h>

namespace fieldproof::results {
namespace {

TEST(SectionTitles, TheNearestAboveIsTaken) {
  const SectionTitles titles = {{"7", "Protocol"},
                                {"7.1", "General"},
                                {"7.1.5", "Detail of instruction"},
                                {"7.1.5 (1)", "Individual reading"},
                                {"Appendix 3.1", "Error codes"}};
  EXPECT_EQ(title_of(titles, "7.1.5 (1)(e)"), "Individual reading");
  EXPECT_EQ(title_of(titles, "7.1.5 (1)"), "Individual reading");
  EXPECT_EQ(title_of(titles, "7.1.5 (10)"), "Detail of instruction");
  EXPECT_EQ(title_of(titles, "7.1.5 Note 2)"), "Detail of instruction");
  EXPECT_EQ(title_of(titles, "Appendix 3.1 (2)"), "Error codes");
  EXPECT_EQ(title_of(titles, "7.1.50"), "") << "another section";
  EXPECT_EQ(title_of(titles, "7.1.6"), "") << "what stands above it is not its title";
  EXPECT_EQ(title_of(titles, "Warranty"), "");
  EXPECT_EQ(title_of(titles, ""), "");
}

TEST(SectionTitles, ASectionIsWithinThoseAboveIt) {
  for (const char* number : {"7", "7.1", "7.1.5", "7.1.5 (1)", "7.1.5 (1)(e)"})
    EXPECT_TRUE(is_within("7.1.5 (1)(e)", number)) << number;
  EXPECT_FALSE(is_within("7.1.5", "7.1.5 (1)"));
  EXPECT_FALSE(is_within("7.10", "7.1"));
  EXPECT_FALSE(is_within("17.1", "7.1"));
}

TEST(SectionTitles, PartsOfAChapter) {
  EXPECT_EQ(part_of("7.1.5 (1)(e)"), "7.1");
  EXPECT_EQ(part_of("7.1"), "7.1");
  EXPECT_EQ(part_of("11"), "11");
  EXPECT_EQ(part_of("1-2-3"), "1-2");
  EXPECT_EQ(part_of("2-4 table 2-4-1"), "2-4");
  EXPECT_EQ(part_of("Appendix 3.1 (2)"), "Appendix 3");
  EXPECT_EQ(part_of("부록 2.1 (1)"), "부록 2");
  EXPECT_EQ(part_of("A.4 (1) table 2"), "A.4");
  EXPECT_EQ(part_of("Safety Instruction"), "Safety Instruction");
  EXPECT_EQ(part_of(""), "");
}

}  // namespace
}  // namespace fieldproof::results
