#include "reports/results/shard.hpp"

#include <gtest/gtest.h>

namespace fieldproof::results {
namespace {

TEST(Shard, IsCountedFromOneInText) {
  EXPECT_EQ(to_string(Shard{0, 3}), "1/3");
  EXPECT_EQ(parse_shard("3/3"), (Shard{2, 3}));
  for (const char* wrong : {"", "1", "0/3", "4/3", "1/0", "-1/3", "1/3 ", "a/b", "1/3, 2/3"})
    EXPECT_EQ(parse_shard(wrong), std::nullopt) << wrong;
}

}  // namespace
}  // namespace fieldproof::results
