#include "src/line/faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "src/line/line.hpp"
#include "src/line/test_settings.hpp"

namespace fieldproof::line {
namespace {

using test::ct;
using test::n81;

const Bytes request{0x10, 0x11, 0x12, 0x13};
const Bytes answer{0x20, 0x21, 0x22, 0x23, 0x24};

/// Answers each burst at once.
class Server : public Device {
 public:
  void receive(const Burst& burst) override {
    heard.push_back(burst);
    due = burst.end();
  }
  std::optional<Time> wake_at() const override { return due; }
  Bytes advance(Time now) override {
    if (!due || *due > now) return {};
    due.reset();
    return answer;
  }
  std::vector<Burst> heard;
  std::optional<Time> due;
};

class Faults : public ::testing::Test {
 protected:
  /// One exchange through the fault; what the bench hears.
  std::vector<Burst> exchange(const LineFaults& faults) {
    FaultyDevice faulty(server, faults, ct);
    SimulatedLine line(n81);
    line.attach(faulty, n81);
    sent = line.transmit(request);
    std::vector<Burst> heard;
    for (Burst burst = line.receive(1s); !burst.bytes.empty(); burst = line.receive(1s))
      heard.push_back(burst);
    return heard;
  }
  Server server;
  SimulatedLine::Transmitted sent;
};

TEST_F(Faults, WithoutOptionsNothingChanges) {
  const auto heard = exchange({});
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].bytes, answer);
  EXPECT_EQ(heard[0].start, sent.end);
  ASSERT_EQ(server.heard.size(), 1u);
  EXPECT_EQ(server.heard[0].bytes, request);
}

TEST_F(Faults, FlipAtAByte) {
  const auto heard = exchange({.request = {.flip = 1, .flip_mask = 0x80}, .reply = {.flip = 4}});
  EXPECT_EQ(server.heard.at(0).bytes, (Bytes{0x10, 0x91, 0x12, 0x13}));
  EXPECT_EQ(heard.at(0).bytes, (Bytes{0x20, 0x21, 0x22, 0x23, 0x25}));
}

TEST_F(Faults, FlipBehindTheLastByteDoesNothing) {
  EXPECT_EQ(exchange({.reply = {.flip = 5}}).at(0).bytes, answer);
}

TEST_F(Faults, NoiseFlipsOneBitAndTheSeedRepeatsIt) {
  const auto first = exchange({.reply = {.noise = 1.0}, .seed = 7});
  ASSERT_EQ(first.at(0).bytes.size(), answer.size());
  for (std::size_t i = 0; i < answer.size(); ++i) {
    EXPECT_EQ(__builtin_popcount(static_cast<unsigned>(first[0].bytes[i] ^ answer[i])), 1);
  }
  EXPECT_EQ(exchange({.reply = {.noise = 1.0}, .seed = 7}).at(0).bytes, first[0].bytes);
  EXPECT_NE(exchange({.reply = {.noise = 1.0}, .seed = 8}).at(0).bytes, first[0].bytes);
}

TEST_F(Faults, NoiseKeepsItsRate) {
  Server quiet;
  FaultyDevice faulty(quiet, {.request = {.noise = 0.01}}, ct);
  faulty.receive({Bytes(100'000, 0x00), 0ns, ct});
  const Bytes& heard = quiet.heard.at(0).bytes;
  const auto flipped = static_cast<int>(heard.size()) -
                       static_cast<int>(std::count(heard.begin(), heard.end(), 0x00));
  EXPECT_NEAR(flipped, 1000, 150);
}

TEST_F(Faults, ADroppedByteLeavesItsTime) {
  const auto heard = exchange({.request = {.drop = 1}, .reply = {.drop = 2}});
  ASSERT_EQ(server.heard.size(), 2u);
  EXPECT_EQ(server.heard[0].bytes, (Bytes{0x10}));
  EXPECT_EQ(server.heard[1].bytes, (Bytes{0x12, 0x13}));
  EXPECT_EQ(server.heard[1].start, sent.start + 2 * ct);
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].bytes, (Bytes{0x20, 0x21}));
  EXPECT_EQ(heard[1].bytes, (Bytes{0x23, 0x24}));
  EXPECT_EQ(heard[1].start, heard[0].end() + ct);
}

TEST_F(Faults, TheFirstAndTheLastByteCanBeDropped) {
  EXPECT_EQ(exchange({.reply = {.drop = 0}}).at(0).bytes, (Bytes{0x21, 0x22, 0x23, 0x24}));
  EXPECT_EQ(exchange({.reply = {.drop = 4}}).at(0).bytes, (Bytes{0x20, 0x21, 0x22, 0x23}));
}

TEST_F(Faults, EchoComesBeforeTheReply) {
  const auto heard = exchange({.echo = true});
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].bytes, request);
  EXPECT_EQ(heard[0].start, sent.end);
  EXPECT_EQ(heard[1].bytes, answer);
  EXPECT_EQ(heard[1].start, heard[0].end());
}

TEST_F(Faults, GapAfterAByte) {
  const auto heard = exchange({.gap_after = 1, .gap = 50ms});
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].bytes, (Bytes{0x20, 0x21}));
  EXPECT_EQ(heard[1].bytes, (Bytes{0x22, 0x23, 0x24}));
  EXPECT_EQ(heard[1].start, heard[0].end() + 50ms);
}

TEST_F(Faults, Truncation) {
  const auto heard = exchange({.request = {.truncate = 3}, .reply = {.truncate = 2}});
  EXPECT_EQ(server.heard.at(0).bytes, (Bytes{0x10, 0x11, 0x12}));
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].bytes, (Bytes{0x20, 0x21}));
}

TEST_F(Faults, TruncationToNothingIsSilence) {
  EXPECT_TRUE(exchange({.reply = {.truncate = 0}}).empty());
  EXPECT_EQ(server.heard.size(), 1u);
  server.heard.clear();
  EXPECT_TRUE(exchange({.request = {.truncate = 0}}).empty());
  EXPECT_TRUE(server.heard.empty());
}

TEST_F(Faults, Late) {
  const auto heard = exchange({.late = 700ms});
  EXPECT_EQ(heard.at(0).start, sent.end + 700ms);
}

TEST_F(Faults, Duplicate) {
  const auto heard = exchange({.duplicate = true});
  ASSERT_EQ(heard.size(), 2u);
  EXPECT_EQ(heard[0].bytes, answer);
  EXPECT_EQ(heard[1].bytes, answer);
  EXPECT_EQ(heard[1].start, heard[0].end());
}

TEST_F(Faults, FaultsCombine) {
  const auto heard = exchange(
      {.reply = {.flip = 0, .truncate = 3}, .echo = true, .late = 10ms, .duplicate = true});
  ASSERT_EQ(heard.size(), 3u);
  EXPECT_EQ(heard[0].bytes, request);
  EXPECT_EQ(heard[1].bytes, (Bytes{0x21, 0x21, 0x22}));
  EXPECT_EQ(heard[2].bytes, (Bytes{0x21, 0x21, 0x22}));
}

TEST_F(Faults, BytesCountThroughABurstThatComesInParts) {
  FaultyDevice faulty(server, {.request = {.flip = 3}}, ct);
  faulty.receive({{0x10, 0x11}, 0ns, ct});
  faulty.receive({{0x12, 0x13}, 2 * ct, ct});
  faulty.receive({{0x10, 0x11, 0x12, 0x13}, 100 * ct, ct});
  EXPECT_EQ(server.heard.at(1).bytes, (Bytes{0x12, 0x12}));
  EXPECT_EQ(server.heard.at(2).bytes, (Bytes{0x10, 0x11, 0x12, 0x12}));
}

}  // namespace
}  // namespace fieldproof::line
