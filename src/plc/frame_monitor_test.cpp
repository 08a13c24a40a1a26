#include "src/plc/frame_monitor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

namespace fieldproof::plc {
namespace {

constexpr Duration character = 1ms;

/// Sends what it is told to, 10 ms after it has heard the last byte.
class Answerer : public SerialDevice {
 public:
  explicit Answerer(Bytes answer) : answer_(std::move(answer)) {}
  void receive(const Burst& burst) override { due_ = burst.end() + 10ms; }
  std::optional<Time> wake_at() const override { return due_; }
  Bytes advance(Time now) override {
    if (!due_ || now < *due_) return {};
    due_.reset();
    return answer_;
  }
  Status set(std::string_view, std::string_view) override { return ok(); }
  Result<std::string> get(std::string_view address, std::size_t) const override {
    return "of the device: " + std::string(address);
  }
  Status act(std::string_view) override { return ok(); }

 private:
  Bytes answer_;
  std::optional<Time> due_;
};

/// Frames end with a full stop; known ones begin with a capital.
class Monitored {
 public:
  explicit Monitored(std::string_view answer = "") {
    MonitorRules rules{[](ByteView bytes) -> std::optional<std::size_t> {
                         const auto stop = std::ranges::find(bytes, '.');
                         if (stop == bytes.end()) return std::nullopt;
                         return static_cast<std::size_t>(stop - bytes.begin()) + 1;
                       },
                       [](ByteView frame, bool sent) {
                         if (frame[0] < 'A' || frame[0] > 'Z') return unknown_frame;
                         return FrameResult{sent ? 2u : 1u, sent ? "client" : "server"};
                       },
                       20ms};
    monitor_ = std::make_unique<FrameMonitor>(
        std::make_unique<Answerer>(to_bytes(answer)), std::move(rules),
        [this](const MonitoredFrame& frame) { frames.push_back(frame); });
  }

  void hear(std::string_view text, Duration pause = 0ms) {
    run(now_ + pause);
    monitor_->receive({to_bytes(text), now_, character});
    now_ += character * static_cast<Duration::rep>(text.size());
  }
  void run(Time until) {
    for (auto wake = monitor_->wake_at(); wake && *wake <= until; wake = monitor_->wake_at())
      monitor_->advance(*wake);
    now_ = std::max(now_, until);
  }
  void power_cycle() { EXPECT_TRUE(monitor_->act("power_cycle")); }
  std::string last() const { return *monitor_->get("@monitor", 0); }
  std::string get(std::string_view address) const { return *monitor_->get(address, 0); }

  std::vector<MonitoredFrame> frames;

 private:
  std::unique_ptr<FrameMonitor> monitor_;
  Time now_{};
};

TEST(FrameMonitor, RecordsReceptionAndTransmission) {
  Monitored one("Yes.");
  EXPECT_EQ(one.last(), "00");
  one.hear("Well.", 100ms);
  ASSERT_EQ(one.frames.size(), 1u);
  EXPECT_FALSE(one.frames[0].sent);
  EXPECT_EQ(one.frames[0].result.text, "server");
  EXPECT_EQ(one.frames[0].time, 105ms);
  EXPECT_EQ(one.last(), "01");
  one.run(1s);
  ASSERT_EQ(one.frames.size(), 2u);
  EXPECT_TRUE(one.frames[1].sent);
  EXPECT_EQ(one.frames[1].time, 115ms);
  EXPECT_EQ(to_text(one.frames[1].data), "Yes.");
  EXPECT_EQ(one.last(), "02");
}

TEST(FrameMonitor, JoinsThePartsOfAFrameAndParts) {
  Monitored one;
  one.hear("A");
  one.hear("b.C");
  one.hear("d.", 20ms);
  ASSERT_EQ(one.frames.size(), 2u);
  EXPECT_EQ(to_text(one.frames[0].data), "Ab.");
  EXPECT_EQ(one.frames[0].time, 3ms) << "the third character ends there";
  EXPECT_EQ(to_text(one.frames[1].data), "Cd.");
}

TEST(FrameMonitor, SilenceEndsWhatIsNoFrame) {
  Monitored one;
  one.hear("Cut", 50ms);
  one.run(72ms);
  EXPECT_TRUE(one.frames.empty());
  one.run(1s);
  ASSERT_EQ(one.frames.size(), 1u);
  EXPECT_EQ(to_text(one.frames[0].data), "Cut");
  EXPECT_EQ(one.frames[0].time, 53ms);
}

TEST(FrameMonitor, WhatTheDeviceAnswersToIsOver) {
  Monitored one("Yes.");
  one.hear("?");
  one.run(15ms);
  ASSERT_EQ(one.frames.size(), 2u);
  EXPECT_EQ(one.frames[0].result, unknown_frame);
  EXPECT_TRUE(one.frames[1].sent);
}

TEST(FrameMonitor, TheBackDoorLeadsToTheDevice) {
  EXPECT_EQ(Monitored().get("@status"), "of the device: @status");
}

TEST(FrameMonitor, KnowsNoFrameAfterAPowerCycle) {
  Monitored one;
  one.hear("Who?");
  one.run(30ms);
  EXPECT_NE(one.last(), "00");
  one.power_cycle();
  EXPECT_EQ(one.last(), "00");
}

TEST(FrameMonitor, Views) {
  // The capture of Cnet EN 11.2.4.
  const MonitoredFrame frame{true,
                             FrameResult{2, "XGT client"},
                             {},
                             to_bytes("\x05"
                                      "01rSS0104%MW0\x04"
                                      "40")};
  EXPECT_EQ(frame.data.size(), 17u);
  EXPECT_EQ(ascii_view(frame), "[ENQ]01rSS0104%MW0[EOT]40");
  EXPECT_EQ(hex_view(frame), "05 30 31 72 53 53 30 31 30 34 25 4D 57 30 04 34 30");
  EXPECT_EQ(ascii_view({false, unknown_frame, {}, *from_hex("5B 00 FF 3C 5D")}),
            "<5B><00><FF><3C>]");
}

TEST(FrameMonitor, Csv) {
  EXPECT_EQ(csv_header(), "Form,Result,Size,Time,Frame data (HEX),Frame data (ASCII)\r\n");
  EXPECT_EQ(csv_row({false, unknown_frame, {}, to_bytes("a,\"b\"")}, "2007/12/4"),
            "Reception,Unknown,5,2007/12/4,61 2C 22 62 22,\"a,\"\"b\"\"\"\r\n");
}

}  // namespace
}  // namespace fieldproof::plc
