#include "src/plc/reply_queue.hpp"

#include <gtest/gtest.h>

namespace fieldproof::plc {
namespace {

TEST(ReplyQueue, EachWhenItIsDueInTheOrderOfRequests) {
  ReplyQueue queue;
  EXPECT_EQ(queue.wake_at(std::nullopt), std::nullopt);
  EXPECT_EQ(queue.wake_at(7ms), 7ms);
  queue.put(10ms, {1});
  queue.put(9ms, {2});
  EXPECT_EQ(queue.wake_at(std::nullopt), 10ms);
  EXPECT_EQ(queue.wake_at(7ms), 7ms);
  EXPECT_EQ(queue.wake_at(11ms), 10ms);
  EXPECT_TRUE(queue.take(10ms - 1ns).empty());
  EXPECT_EQ(queue.take(10ms), Bytes{1});
  EXPECT_EQ(queue.take(10ms), Bytes{2});
  EXPECT_TRUE(queue.take(1s).empty());
}

TEST(ReplyQueue, Clear) {
  ReplyQueue queue;
  queue.put(10ms, {1});
  queue.clear();
  EXPECT_EQ(queue.wake_at(std::nullopt), std::nullopt);
}

}  // namespace
}  // namespace fieldproof::plc
