#include "harness/vectors/filter.hpp"

#include <gtest/gtest.h>

namespace fieldproof::vectors {
namespace {

TEST(Filter, GlobsCrossSlashesAndExclude) {
  EXPECT_TRUE(matches_filter("a/b/c", ""));
  EXPECT_TRUE(matches_filter("a/b/c", "a/*"));
  EXPECT_TRUE(matches_filter("a/b/c", "x:*c"));
  EXPECT_TRUE(matches_filter("a/b/c", "a/?/c"));
  EXPECT_FALSE(matches_filter("a/b/c", "a/b"));
  EXPECT_FALSE(matches_filter("a/b/c", "a/*:-*c"));
  EXPECT_TRUE(matches_filter("a/b/d", "-*c"));
}

TEST(Filter, AStarGivesBackWhatTheRestNeeds) {
  EXPECT_TRUE(matches_filter("aXbXc", "*X*c"));
  EXPECT_TRUE(matches_filter("aXbXc", "a*Xc"));
  EXPECT_TRUE(matches_filter("abab", "*ab"));
  EXPECT_TRUE(matches_filter("ab", "a*b**"));
  EXPECT_FALSE(matches_filter("aXbXc", "*X"));
  EXPECT_FALSE(matches_filter("ab", "a*?b"));
  EXPECT_FALSE(matches_filter("ab", "ab?"));
}

TEST(Filter, TheFoldersOfItsIdsAreKnownWhereEachIsNamed) {
  EXPECT_EQ(folders_of_filter("a/b/*:c/?:-c/d"), "a/*:c/*");
  for (const char* any : {"", "*", "a*/b", "a/*:*/b", "-a/*", "-a/*:b/*", "a"})
    EXPECT_EQ(folders_of_filter(any), "") << any;
}

TEST(Filter, AMistypedOneIsSaid) {
  const std::vector<std::string> ids{"xgt_cnet/rss/two_words", "xgt_cnet/wss/one_word",
                                     "modbus_rtu/limits/a"};
  EXPECT_EQ(meant_filter("xgt_cnet/rs/*", ids), "; did you mean 'xgt_cnet/rss'?");
  EXPECT_EQ(meant_filter("xgt-cnet/*", ids), "; did you mean 'xgt_cnet'?");
  EXPECT_EQ(meant_filter("modbus_rtu/*:xgt_cnet/rss/two_wrds", ids),
            "; did you mean 'xgt_cnet/rss/two_words'?");
  EXPECT_EQ(meant_filter("xgt_cnet/rss", ids), "; did you mean 'xgt_cnet/rss/*'?");
  EXPECT_EQ(meant_filter("*/nothing", ids), "");
  EXPECT_EQ(meant_filter("modbus_rtu/*:-x", ids), "");
}

TEST(Filter, AStemMayGoOnInAnyWay) {
  EXPECT_TRUE(may_match_filter("a/b", ""));
  EXPECT_TRUE(may_match_filter("a/b", "-a/*"));
  EXPECT_TRUE(may_match_filter("a/b", "a/b/c/d"));
  EXPECT_TRUE(may_match_filter("a/b", "a/b"));
  EXPECT_TRUE(may_match_filter("a/b", "x/y:*c"));
  EXPECT_TRUE(may_match_filter("a/b", "a/?/c"));
  EXPECT_FALSE(may_match_filter("a/b", "a/c/*"));
  EXPECT_FALSE(may_match_filter("a/b", "a"));
  EXPECT_FALSE(may_match_filter("a/b", "x/*:y/*"));
}

TEST(Filter, WhatMatchesMayMatchFromEveryStem) {
  const std::string_view id = "xgt_cnet/rss/refused/lower";
  for (const std::string_view filter : {"*", "xgt_cnet/*", "*lower", "x*/?ss?ref*:-*upper",
                                        "xgt_cnet/rss/refused/lower", "a:*/lower"})
    for (std::size_t size = 0; size <= id.size(); ++size)
      EXPECT_TRUE(matches_filter(id, filter) && may_match_filter(id.substr(0, size), filter))
          << filter << ' ' << size;
}

}  // namespace
}  // namespace fieldproof::vectors
