#include "reports/results/extract.hpp"

#include <gmock/gmock.h>

#include "reports/results/sha256.hpp"

namespace fieldproof::results {
namespace {

using testing::SizeIs;

Bytes counting(std::size_t count) {
  Bytes bytes(count);
  for (std::size_t i = 0; i < count; ++i) bytes[i] = static_cast<Byte>(i % 251);
  return bytes;
}

Event received(Time start, Bytes bytes, int step = 1) {
  return {Event::Kind::received, start, start + 1ms, std::move(bytes), "", step};
}

TEST(Cut, KeepsBothEndsCountAndHash) {
  Bytes bytes = counting(1201);
  const Extract extract = cut(bytes, 1200);
  const Bytes all = counting(1201);
  EXPECT_EQ(bytes, Bytes(all.begin(), all.begin() + 64));
  EXPECT_EQ(extract.tail, Bytes(all.end() - 64, all.end()));
  EXPECT_EQ(extract.count, 1201u);
  EXPECT_EQ(extract.left_out(bytes.size()), 1201u - 128u);
  // python3 -c "import hashlib; print(hashlib.sha256(bytes(i % 251 for i in
  // range(1201))).hexdigest())"
  EXPECT_EQ(extract.sha256, "ab1328331dab8e032cd78c69854686a45f1c90e7542d01ba1022e51caaeb8857");
}

TEST(Cut, LeavesWhatIsNoLonger) {
  Bytes bytes = counting(1200), few = counting(128);
  EXPECT_TRUE(cut(bytes, 1200).empty());
  EXPECT_EQ(bytes, counting(1200));
  EXPECT_TRUE(cut(few, 10).empty()) << "both ends are all of it";
}

TEST(CutRuns, MakeOneEventOfAFlood) {
  std::vector<Event> exchange{{Event::Kind::sent, 0ms, 1ms, counting(20), "", 0}};
  for (int i = 0; i < 100; ++i) exchange.push_back(received(10ms * (i + 1), counting(20)));
  exchange.push_back(received(2s, counting(20), 2));
  cut_runs(exchange, 1200);
  ASSERT_THAT(exchange, SizeIs(3));
  EXPECT_EQ(exchange[1].start, 10ms);
  EXPECT_EQ(exchange[1].end, 1001ms);
  EXPECT_EQ(exchange[1].extract.count, 2000u);
  EXPECT_THAT(exchange[1].bytes, SizeIs(64));
  EXPECT_EQ(exchange[1].step, 1);
  EXPECT_TRUE(exchange[2].extract.empty());
}

TEST(CutRuns, LeaveTheTimesOfWhatIsNotTooMuch) {
  std::vector<Event> exchange;
  for (int i = 0; i < 60; ++i) exchange.push_back(received(10ms * (i + 1), counting(20)));
  cut_runs(exchange, 1200);
  EXPECT_THAT(exchange, SizeIs(60));
}

TEST(CutRuns, JoinNothingOverALinkAStepOrASend) {
  std::vector<Event> exchange{received(1ms, counting(700)), received(2ms, counting(700), 2),
                              received(3ms, counting(700), 2)};
  exchange.back().link = "other";
  exchange.push_back({Event::Kind::sent, 4ms, 5ms, counting(2000), "", 2});
  exchange.push_back(received(6ms, counting(700), 2));
  exchange.back().link = "other";
  cut_runs(exchange, 1200);
  EXPECT_THAT(exchange, SizeIs(5));
  for (const Event& event : exchange) EXPECT_TRUE(event.extract.empty());
  EXPECT_THAT(exchange[3].bytes, SizeIs(2000)) << "what is sent is ours";
}

}  // namespace
}  // namespace fieldproof::results
