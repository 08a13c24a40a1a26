#include "harness/vectors/in_threads.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace fieldproof::vectors {
namespace {

TEST(InThreads, EachPartIsDoneOnce) {
  std::vector<std::atomic<int>> done(1000);
  in_threads(done.size(), [&](std::size_t i) { ++done[i]; });
  for (const std::atomic<int>& one : done) EXPECT_EQ(one, 1);
}

TEST(InThreads, NothingIsNothing) {
  in_threads(0, [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace fieldproof::vectors
