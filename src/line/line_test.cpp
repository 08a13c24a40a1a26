#include "src/line/line.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <stdexcept>

#include "src/line/test_settings.hpp"

namespace fieldproof::line {
namespace {

using test::ct;
using test::n81;

/// Writes down what it hears and when it is advanced; transmits what the test has planned.
class Station : public Device {
 public:
  void receive(const Burst& burst) override {
    EXPECT_GE(burst.end(), time_) << "bytes from the past";
    time_ = burst.end();
    heard.push_back(burst);
    if (heard_log) heard_log->push_back(name);
    if (reply_after) plan.emplace(burst.end() + *reply_after, reply);
  }
  std::optional<Time> wake_at() const override {
    if (plan.empty()) return std::nullopt;
    return plan.begin()->first;
  }
  Bytes advance(Time now) override {
    EXPECT_GE(now, time_) << "time went back";
    time_ = now;
    advanced.push_back(now);
    if (plan.empty() || plan.begin()->first > now) return {};
    Bytes bytes = plan.begin()->second;
    plan.erase(plan.begin());
    return bytes;
  }
  Bytes all() const {
    Bytes bytes;
    for (const Burst& burst : heard)
      bytes.insert(bytes.end(), burst.bytes.begin(), burst.bytes.end());
    return bytes;
  }

  std::string name;
  std::vector<std::string>* heard_log = nullptr;
  std::vector<Burst> heard;
  std::vector<Time> advanced;
  std::multimap<Time, Bytes> plan;
  std::optional<Duration> reply_after;
  Bytes reply{0x06};

 private:
  Time time_{};
};

TEST(Line, TimesAreExactAtEverySpeedAndFormat) {
  for (const int baud : {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200}) {
    for (const int data : {7, 8}) {
      for (const char parity : {'N', 'E', 'O'}) {
        for (const int stop : {1, 2}) {
          const LineSettings settings{baud, data, parity, stop};
          const Duration character((1 + data + (parity != 'N') + stop) * 1'000'000'000LL / baud);
          SimulatedLine line(settings);
          Station station;
          station.reply_after = 3ms;
          station.reply = {0x06, 0x31};
          line.attach(station, settings);
          const auto sent = line.transmit(Bytes{0x05, 0x30, 0x04});
          EXPECT_EQ(sent.start, 0ns);
          EXPECT_EQ(sent.end, 3 * character);
          EXPECT_EQ(line.now(), 3 * character);
          ASSERT_EQ(station.heard.size(), 1u) << to_string(settings);
          EXPECT_EQ(station.heard[0].bytes, (Bytes{0x05, 0x30, 0x04}));
          EXPECT_EQ(station.heard[0].end(), 3 * character);
          const Burst reply = line.receive(1s);
          EXPECT_EQ(reply.bytes, (Bytes{0x06, 0x31}));
          EXPECT_EQ(reply.start, 3 * character + 3ms);
          EXPECT_EQ(reply.end(), 5 * character + 3ms);
          EXPECT_EQ(line.now(), reply.end());
        }
      }
    }
  }
}

TEST(Line, SilenceCostsTheTimeThatWasGiven) {
  SimulatedLine line(n81, Duplex::full, 5s);
  Station station;
  line.attach(station, n81);
  const Burst burst = line.receive(7s);
  EXPECT_TRUE(burst.bytes.empty());
  EXPECT_EQ(line.now(), 7s);
  EXPECT_TRUE(line.receive(1s).bytes.empty());  // in the past
  EXPECT_EQ(line.now(), 7s);
}

TEST(Line, AStationIsSwitchedOnWhenItIsAttached) {
  SimulatedLine line(n81, Duplex::full, 5s);
  Station station;
  line.attach(station, n81);
  EXPECT_EQ(station.advanced, (std::vector<Time>{5s}));
}

TEST(Line, TwoSendsAreBackToBack) {
  SimulatedLine line(n81);
  Station station;
  line.attach(station, n81);
  const auto first = line.transmit(Bytes{1, 2});
  const auto second = line.transmit(Bytes{3});
  EXPECT_EQ(second.start, first.end);
  ASSERT_EQ(station.heard.size(), 2u);
  EXPECT_EQ(station.heard[1].start, station.heard[0].end());
}

TEST(Line, NothingToTransmitTakesNoTime) {
  SimulatedLine line(n81);
  const auto sent = line.transmit({});
  EXPECT_EQ(sent.start, sent.end);
  EXPECT_EQ(line.now(), 0ns);
}

TEST(Line, SevenBitSendersDropBitSeven) {
  const LineSettings e71{9600, 7, 'E', 1};
  SimulatedLine line(e71);
  Station station;
  station.reply_after = 0ns;
  station.reply = {0xC2};
  line.attach(station, e71);
  line.transmit(Bytes{0xC1});
  EXPECT_EQ(station.all(), (Bytes{0x41}));
  EXPECT_EQ(line.receive(1s).bytes, (Bytes{0x42}));
}

TEST(Line, EveryoneHearsEveryoneElse) {
  SimulatedLine line(n81);
  Station a, b;
  a.reply_after = 1ms;
  a.reply = {0x61, 0x62};
  line.attach(a, n81);
  line.attach(b, n81);
  line.transmit(Bytes{0x05});
  EXPECT_EQ(line.receive(1s).bytes, (Bytes{0x61, 0x62}));
  EXPECT_EQ(a.all(), (Bytes{0x05}));  // not itself
  EXPECT_EQ(b.all(), (Bytes{0x05, 0x61, 0x62}));
  EXPECT_TRUE(line.receive(2s).bytes.empty());  // and the bench does not hear itself
}

TEST(Line, StationsRunInTheOrderOfTime) {
  SimulatedLine line(n81);
  Station a, b;
  std::vector<std::string> log;
  a.name = "a", b.name = "b";
  a.heard_log = b.heard_log = &log;
  a.plan = {{10ms, {1}}, {30ms, {3}}};
  b.plan = {{20ms, {2}}};
  line.attach(a, n81);
  line.attach(b, n81);
  EXPECT_EQ(line.receive(1s).start, 10ms);
  EXPECT_EQ(line.receive(1s).start, 20ms);
  EXPECT_EQ(line.receive(1s).start, 30ms);
  EXPECT_EQ(log, (std::vector<std::string>{"b", "a", "b"}));
  EXPECT_EQ(a.advanced, (std::vector<Time>{0ms, 10ms, 30ms}));
  EXPECT_EQ(b.advanced, (std::vector<Time>{0ms, 20ms}));
}

TEST(Line, ADeviceHearsTheBytesBeforeItsWakeAndTheOthersAfter) {
  SimulatedLine line(n81);
  Station station, other;
  station.plan = {{2 * ct + 1us, {}}};  // wakes inside the third character, has nothing to say
  line.attach(station, n81);
  line.attach(other, n81);
  line.transmit(Bytes{1, 2, 3, 4});
  ASSERT_EQ(station.heard.size(), 2u);
  EXPECT_EQ(station.heard[0].bytes, (Bytes{1, 2}));
  EXPECT_EQ(station.heard[1].bytes, (Bytes{3, 4}));
  EXPECT_EQ(station.heard[1].start, 2 * ct);
  EXPECT_EQ(station.advanced.back(), 2 * ct + 1us);
  ASSERT_EQ(other.heard.size(), 1u);  // no need to cut for the others
}

TEST(Line, ABytesEndComesBeforeAWakeAtTheSameMoment) {
  SimulatedLine line(n81);
  Station station;
  station.plan = {{2 * ct, {}}};
  line.attach(station, n81);
  line.transmit(Bytes{1, 2, 3});
  ASSERT_EQ(station.heard.size(), 2u);
  EXPECT_EQ(station.heard[0].bytes, (Bytes{1, 2}));
}

TEST(Line, ABurstIsTakenInPartsAtTheDeadline) {
  SimulatedLine line(n81);
  Station station;
  station.plan = {{0ns, {1, 2, 3}}};
  line.attach(station, n81);
  const Burst head = line.receive(2 * ct + 1us);
  EXPECT_EQ(head.bytes, (Bytes{1, 2}));
  EXPECT_EQ(line.now(), 2 * ct + 1us);
  const Burst tail = line.receive(1s);
  EXPECT_EQ(tail.bytes, (Bytes{3}));
  EXPECT_EQ(tail.start, 2 * ct);
  EXPECT_EQ(line.now(), 3 * ct);
}

TEST(Line, FramesOfOneStationQueueBehindEachOther) {
  SimulatedLine line(n81);
  Station station;
  station.plan = {{1ms, {1, 2}}, {1ms, {3}}};
  line.attach(station, n81);
  const Burst first = line.receive(1s);
  const Burst second = line.receive(1s);
  EXPECT_EQ(first.bytes, (Bytes{1, 2}));
  EXPECT_EQ(second.bytes, (Bytes{3}));
  EXPECT_EQ(second.start, first.end());
}

TEST(Line, WorkThatComesUpBetweenCallsBeginsNow) {
  SimulatedLine line(n81);
  Station station;
  line.attach(station, n81);
  (void)line.receive(1s);
  station.plan = {{0ns, {7}}};  // as a client whose flag has just been set
  const Burst burst = line.receive(2s);
  EXPECT_EQ(burst.bytes, (Bytes{7}));
  EXPECT_EQ(burst.start, 1s);
}

TEST(Line, FullDuplexCarriesBothDirectionsAtOnce) {
  SimulatedLine line(n81);
  Station station;
  station.plan = {{ct, {0x61, 0x62}}};
  line.attach(station, n81);
  line.transmit(Bytes{1, 2, 3, 4});
  const Burst heard = line.receive(1s);
  EXPECT_EQ(heard.bytes, (Bytes{0x61, 0x62}));
  EXPECT_EQ(heard.start, ct);
  EXPECT_EQ(station.all(), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(line.now(), 4 * ct);  // heard during the transmission: time does not go back
  EXPECT_EQ(line.take_errors(), LineErrors{});
}

TEST(Line, HalfDuplexHearsNothingWhileItTransmits) {
  SimulatedLine line(n81, Duplex::half);
  Station station;
  station.plan = {{ct, {0x61, 0x62}}};
  line.attach(station, n81);
  line.transmit(Bytes{1, 2, 3, 4});
  EXPECT_TRUE(line.receive(1s).bytes.empty());
  EXPECT_EQ(station.all(), (Bytes{1, 4}));  // deaf during its own two characters
}

TEST(Line, HalfDuplexWithoutOverlapIsAsFullDuplex) {
  SimulatedLine line(n81, Duplex::half);
  Station station;
  station.reply_after = 0ns;
  line.attach(station, n81);
  line.transmit(Bytes{1, 2});
  EXPECT_EQ(line.receive(1s).bytes, (Bytes{0x06}));
}

TEST(Line, CollidingStationsAreGarbledWhereTheyOverlap) {
  SimulatedLine line(n81);
  Station a, b;
  a.plan = {{0ns, {0xF5, 0x33}}};
  b.plan = {{0ns, {0x5F}}};
  line.attach(a, n81);
  line.attach(b, n81);
  Bytes heard;
  for (Burst burst = line.receive(1s); !burst.bytes.empty(); burst = line.receive(1s)) {
    heard.insert(heard.end(), burst.bytes.begin(), burst.bytes.end());
  }
  EXPECT_EQ(heard, (Bytes{0x55, 0x33}));
  EXPECT_EQ(a.all(),
            (Bytes{0x5F}));  // stations hear each other clean: the collision is at the third
  EXPECT_EQ(b.all(), (Bytes{0xF5, 0x33}));
}

TEST(Line, BytesBeforeACollisionAreHeardAsTheyAre) {
  SimulatedLine line(n81);
  Station a, b;
  a.plan = {{0ns, {0x11, 0xFF, 0x33}}};
  b.plan = {{ct + ct / 2, {0x00}}};  // low from the middle of the second character into the third
  line.attach(a, n81);
  line.attach(b, n81);
  EXPECT_EQ(line.receive(1s).bytes, (Bytes{0x11}));
  Bytes rest;
  for (Burst burst = line.receive(1s); !burst.bytes.empty(); burst = line.receive(1s)) {
    rest.insert(rest.end(), burst.bytes.begin(), burst.bytes.end());
  }
  EXPECT_EQ(std::count(rest.begin(), rest.end(), 0xFF), 0);
  EXPECT_GT(line.take_errors().framing, 0);
  EXPECT_EQ(line.take_errors(), LineErrors{});
}

TEST(Line, TheLineIsCleanAgainAfterACollision) {
  SimulatedLine line(n81);
  Station a, b;
  a.plan = {{0ns, {0xF0, 0x33}}, {1s, {1, 2, 3}}};
  b.plan = {{ct / 3, {0x0F}}};
  line.attach(a, n81);
  line.attach(b, n81);
  while (line.now() < 500ms) (void)line.receive(500ms);
  const Burst burst = line.receive(2s);
  EXPECT_EQ(burst.bytes, (Bytes{1, 2, 3}));
  EXPECT_EQ(burst.start, 1s);
}

TEST(Line, MismatchedSettingsAreReadBitByBit) {
  SimulatedLine line(n81);
  Station station;
  const LineSettings e71{9600, 7, 'E', 1};
  station.plan = {{1s, {0x41, 0x43}}};
  line.attach(station, e71);
  line.transmit(Bytes{0x41, 0x43, 0xC3});
  EXPECT_EQ(station.all(), (Bytes{0x41, 0x43}));  // 43 has the wrong parity, C3 reads as 43
  ASSERT_EQ(station.heard.size(), 2u);
  EXPECT_EQ(station.heard[1].start, 2 * ct);
  EXPECT_EQ(line.receive(2s).bytes, (Bytes{0x41}));
  EXPECT_EQ(line.receive(2s).bytes, (Bytes{0xC3}));
  EXPECT_EQ(line.take_errors(), LineErrors{});
}

TEST(Line, ASlowReceiverHearsTheCharacterAfterTheSenderHasEnded) {
  const LineSettings fast{57600, 8, 'N', 1}, slow{19200, 8, 'N', 1};
  SimulatedLine line(fast);
  Station station;
  line.attach(station, slow);
  const auto sent = line.transmit(Bytes{0x80});
  EXPECT_TRUE(station.heard.empty());
  (void)line.receive(1s);
  EXPECT_EQ(station.all(), (Bytes{0xFC}));
  EXPECT_GT(station.heard.at(0).end(), sent.end);
}

TEST(Line, ErrorsOfTheBenchAreCounted) {
  SimulatedLine line(n81);
  Station station;
  station.plan = {{0ns, {0x41, 0x41}}};
  line.attach(station, {9600, 8, 'E', 1});  // parity 0 stands where the bench expects a stop bit
  EXPECT_TRUE(line.receive(1s).bytes.empty());
  EXPECT_EQ(line.take_errors().framing, 2);
}

TEST(Line, StationsOfOtherSettingsDoNotDisturbThoseThatAgree) {
  SimulatedLine line(n81);
  Station same, other;
  same.reply_after = 0ns;
  same.reply = {0x61, 0x62, 0x63};
  line.attach(same, n81);
  line.attach(other, {19200, 8, 'N', 1});
  for (int i = 0; i < 3; ++i) {
    line.transmit(Bytes{1, 2});
    EXPECT_EQ(line.receive(line.now() + 1s).bytes, same.reply);
  }
  EXPECT_EQ(same.all(), (Bytes{1, 2, 1, 2, 1, 2}));
  EXPECT_NE(other.all(), (Bytes{1, 2, 1, 2, 1, 2}));
}

using Heard = std::vector<std::pair<Time, Byte>>;

Heard by_character(const std::vector<Burst>& bursts) {
  Heard heard;
  for (const Burst& burst : bursts) {
    for (std::size_t i = 0; i < burst.bytes.size(); ++i) {
      heard.emplace_back(burst.start + static_cast<Duration::rep>(i) * burst.character_time,
                         burst.bytes[i]);
    }
  }
  return heard;
}

struct Spoken {
  std::size_t sender;
  Burst burst;
};

/// What a listener must hear, from all transmissions at once and bit by bit.
Heard expected_at(std::size_t listener, const std::vector<Spoken>& all,
                  const std::vector<LineSettings>& settings, Duplex duplex) {
  Waveform wave;
  for (const auto& [sender, burst] : all) {
    if (sender != listener)
      wave.add(burst, settings[sender]);
    else if (duplex == Duplex::half)
      wave.mute(burst.start, burst.end());
  }
  Heard heard;
  for (auto c = next_character(wave, settings[listener], 0ns); c;
       c = next_character(wave, settings[listener], c->hunt_from)) {
    if (c->good()) heard.emplace_back(c->start, c->value);
  }
  return heard;
}

// The line mixes whole bursts, parts and single characters; whatever the traffic, it must come to
// what the bits say.
TEST(Line, AnyTrafficIsHeardAsTheBitsSay) {
  std::mt19937 random(20240607);
  const auto pick = [&](unsigned n) { return random() % n; };
  for (int round = 0; round < 300; ++round) {
    const Duplex duplex = pick(2) ? Duplex::full : Duplex::half;
    const bool mixed = pick(3) == 0;
    const unsigned traffic_ms = pick(2) ? 60 : 600;  // crowded or quiet
    std::vector<LineSettings> settings;
    for (int i = 0; i < 4; ++i) {
      settings.push_back(mixed && pick(2) ? LineSettings{pick(2) ? 9600 : 19200, pick(2) ? 7 : 8,
                                                         "NEO"[pick(3)], 1}
                                          : n81);
    }
    const auto frame = [&] {
      Bytes bytes(1 + pick(8));
      for (Byte& b : bytes) b = static_cast<Byte>(random());
      return bytes;
    };
    std::vector<Station> stations(3);
    std::vector<Spoken> all;
    const auto speak = [&](std::size_t sender, Bytes bytes, Time start) {
      drop_unsent_bits(bytes, settings[sender]);
      all.push_back({sender, {bytes, start, settings[sender].character_time()}});
    };
    SimulatedLine line(settings[0], duplex);
    for (std::size_t i = 0; i < 3; ++i) {
      for (auto n = pick(4); n > 0; --n)
        stations[i].plan.emplace(std::chrono::microseconds(1 + pick(traffic_ms * 1000)), frame());
      Time free{};
      for (const auto& [start, bytes] : stations[i].plan) {
        speak(i + 1, bytes, std::max(start, free));
        free = all.back().burst.end();
      }
      line.attach(stations[i], settings[i + 1]);
    }
    std::vector<Burst> heard;
    for (auto n = pick(4); n > 0; --n) {
      const Time moment = line.now() + std::chrono::microseconds(pick(traffic_ms * 500));
      for (Burst burst = line.receive(moment); !burst.bytes.empty(); burst = line.receive(moment))
        heard.push_back(burst);
      const Bytes bytes = frame();
      speak(0, bytes, line.transmit(bytes).start);
    }
    for (Burst burst = line.receive(5s); !burst.bytes.empty(); burst = line.receive(5s))
      heard.push_back(burst);
    EXPECT_EQ(by_character(heard), expected_at(0, all, settings, duplex))
        << "bench, round " << round;
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(by_character(stations[i].heard), expected_at(i + 1, all, settings, duplex))
          << "station " << i + 1 << ", round " << round;
    }
    if (HasFailure()) return;
  }
}

TEST(Line, ADeviceThatNeverRestsIsAProgrammingError) {
  class Restless : public Device {
   public:
    void receive(const Burst&) override {}
    std::optional<Time> wake_at() const override { return Time{}; }
    Bytes advance(Time) override { return {}; }
  } restless;
  SimulatedLine line(n81);
  line.attach(restless, n81);
  EXPECT_THROW((void)line.receive(1s), std::logic_error);
}

}  // namespace
}  // namespace fieldproof::line
