#include "src/base/medium.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>

namespace fieldproof {
namespace {

/// Hears at planned moments; what it hears may make another hear at once.
class Planned : public Medium {
 public:
  Time now() const override { return now_; }
  std::optional<Time> next_event() const override {
    if (plan.empty()) return std::nullopt;
    return std::max(plan.begin()->first, now_);
  }
  void run(Time until) override {
    EXPECT_LE(now_, until) << "time went back";
    if (!plan.empty() && plan.begin()->first <= until) {
      now_ = std::max(now_, plan.begin()->first);
      heard_ = Burst{.bytes = {plan.begin()->second}, .start = now_};
      plan.erase(plan.begin());
      if (wakes) wakes->plan.emplace(now_, 0xFF);
      return;
    }
    now_ = until;
  }
  std::optional<Burst> take() override { return std::exchange(heard_, std::nullopt); }
  std::optional<Burst> take_part() override {
    if (part.empty()) return std::nullopt;
    return Burst{.bytes = std::exchange(part, {}), .start = now_};
  }

  std::multimap<Time, Byte> plan;
  Planned* wakes = nullptr;
  Bytes part;

 private:
  Time now_{};
  std::optional<Burst> heard_;
};

class InStep : public testing::Test {
 protected:
  Bytes next(Time until) {
    const Burst burst = receive_in_step(media_, until);
    EXPECT_EQ(a.now(), b.now());
    EXPECT_EQ(burst.start, a.now());
    return burst.bytes;
  }
  Planned a, b;

 private:
  std::array<Medium*, 2> media_{&a, &b};
};

TEST_F(InStep, WhatComesFirstIsHeardFirst) {
  a.plan = {{1ms, 1}, {4ms, 4}};
  b.plan = {{2ms, 2}, {3ms, 3}};
  for (const Byte expected : {1, 2, 3, 4}) EXPECT_EQ(next(1s), Bytes{expected});
  EXPECT_EQ(next(1s), Bytes{});
  EXPECT_EQ(a.now(), 1s);
}

TEST_F(InStep, NothingIsHeardAfterTheMomentItWaitsFor) {
  b.plan = {{2ms, 2}};
  EXPECT_EQ(next(1ms), Bytes{});
  EXPECT_EQ(b.now(), 1ms);
  EXPECT_EQ(next(2ms), Bytes{2});
  EXPECT_EQ(next(1ms), Bytes{});  // time does not go back
  EXPECT_EQ(b.now(), 2ms);
}

TEST_F(InStep, OneMayWakeAnotherThatHasPassedThatMoment) {
  b.plan = {{2ms, 2}};
  b.wakes = &a;
  EXPECT_EQ(next(2ms), Bytes{2});
  EXPECT_EQ(next(2ms), Bytes{0xFF});
  EXPECT_EQ(next(2ms), Bytes{});
}

TEST_F(InStep, ThePartThatIsBeingHeardComesLast) {
  a.part = {7};
  b.plan = {{1ms, 1}};
  EXPECT_EQ(next(1ms), Bytes{1});
  EXPECT_EQ(next(1ms), Bytes{7});
  EXPECT_EQ(next(1ms), Bytes{});
}

}  // namespace
}  // namespace fieldproof
