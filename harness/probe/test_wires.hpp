// What can be wrong between bench and device, for the tests of the search.
#pragma once

#include <deque>
#include <utility>

#include "harness/probe/test_line.hpp"

namespace fieldproof::probe::test {

/// Nobody there.
class Deaf final : public line::Device {
 public:
  void receive(const Burst&) override {}
  std::optional<Time> wake_at() const override { return std::nullopt; }
  Bytes advance(Time) override { return {}; }
};
inline const endpoints::Decorator switched_off = [](line::Device&, const line::LineSettings&) {
  return std::make_unique<Deaf>();
};

/// Our transmitter is heard by our receiver.
class Echo final : public Wire {
 public:
  Echo(std::unique_ptr<endpoints::Endpoint> inner, const line::LineSettings&)
      : Wire(std::move(inner)) {}
  using endpoints::Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override {
    const Result<Sent> sent = inner_->send(bytes);
    if (sent) echo_.push_back({Bytes(bytes.begin(), bytes.end()), sent->start, character_time()});
    return sent;
  }
  Result<Burst> receive(Time deadline) override {
    if (echo_.empty()) return inner_->receive(deadline);
    Burst burst = std::move(echo_.front());
    echo_.pop_front();
    return burst;
  }

 private:
  std::deque<Burst> echo_;
};

/// The pair on which we listen is swapped: the line idles low, and each level is the other one.
/// 8N1.
class Swapped final : public Wire {
 public:
  Swapped(std::unique_ptr<endpoints::Endpoint> inner, const line::LineSettings&)
      : Wire(std::move(inner)) {}
  Result<Burst> receive(Time deadline) override {
    Result<Burst> burst = inner_->receive(deadline);
    if (burst && !burst->bytes.empty()) burst->bytes = read(burst->bytes);
    return burst;
  }
  std::string line_errors() override {
    return std::exchange(errors_, 0) > 0 ? "some framing errors" : "";
  }

 private:
  Bytes read(const Bytes& sent) {
    std::vector<bool> levels{false};
    for (const Byte byte : sent) {
      levels.push_back(true);  // start bit
      for (int bit = 0; bit < 8; ++bit) levels.push_back((byte >> bit & 1) == 0);
      levels.push_back(false);  // stop bit
    }
    levels.insert(levels.end(), 12, false);
    Bytes heard;
    for (std::size_t at = 1; at + 9 < levels.size(); ++at) {
      if (!levels[at - 1] || levels[at]) continue;  // no falling edge
      Byte value = 0;
      for (int bit = 0; bit < 8; ++bit)
        value |= static_cast<Byte>(levels[at + 1 + static_cast<std::size_t>(bit)] << bit);
      if (levels[at + 9])
        heard.push_back(value);
      else
        ++errors_;
      at += 8;
    }
    return heard;
  }
  int errors_ = 0;
};

/// Nothing holds the idle line: each change of direction rings.
class Floating final : public Wire {
 public:
  Floating(std::unique_ptr<endpoints::Endpoint> inner, const line::LineSettings&)
      : Wire(std::move(inner)) {}
  using endpoints::Endpoint::send;
  Result<Sent> send(ByteView bytes, LinkId) override {
    const Result<Sent> sent = inner_->send(bytes);
    ringing_ = true;
    return sent;
  }
  Result<Burst> receive(Time deadline) override {
    if (std::exchange(ringing_, false)) return Burst{{0x00, 0xFF, 0x00}, now(), character_time()};
    return inner_->receive(deadline);
  }

 private:
  bool ringing_ = false;
};

/// Answers any question with these bytes.
class Canned final : public line::Device {
 public:
  Canned(Bytes reply) : reply_(std::move(reply)) {}
  void receive(const Burst& burst) override { at_ = burst.end() + 5ms; }
  std::optional<Time> wake_at() const override { return at_; }
  Bytes advance(Time now) override {
    if (!at_ || now < *at_) return {};
    at_.reset();
    return reply_;
  }

 private:
  Bytes reply_;
  std::optional<Time> at_;
};
inline endpoints::Decorator answers(Bytes reply) {
  return
      [reply](line::Device&, const line::LineSettings&) { return std::make_unique<Canned>(reply); };
}

/// A master that asks station 9, five times a second.
class Master final : public line::Device {
 public:
  void receive(const Burst&) override {}
  std::optional<Time> wake_at() const override { return next_; }
  Bytes advance(Time now) override {
    if (next_ == Time{}) next_ = now;
    if (now < next_) return {};
    next_ = now + 200ms;
    return protocol_named("modbus-rtu").probe(9, {});
  }

 private:
  Time next_{};
};

/// The device takes any format, but answers in its own: the reply shows which one.
class OwnFormat final : public Wire {
 public:
  OwnFormat(std::unique_ptr<endpoints::Endpoint> inner, const line::LineSettings& bench,
            const char* device)
      : Wire(std::move(inner)), bench_(bench), device_(*line::parse_line_settings(device)) {}
  Result<Burst> receive(Time deadline) override {
    Result<Burst> burst = inner_->receive(deadline);
    if (!burst || burst->bytes.empty()) return burst;
    const line::Reading reading =
        line::read_burst({burst->bytes, burst->start, device_.character_time()}, device_, bench_);
    parity_ += reading.errors.parity;
    framing_ += reading.errors.framing;
    Burst read{{}, burst->start, bench_.character_time()};
    for (const Burst& one : reading.bursts)
      read.bytes.insert(read.bytes.end(), one.bytes.begin(), one.bytes.end());
    if (read.bytes.empty()) return inner_->receive(deadline);
    return read;
  }
  std::string line_errors() override {
    std::string text;
    if (std::exchange(parity_, 0)) text = "some parity errors ";
    if (std::exchange(framing_, 0)) text += "some framing errors";
    return text;
  }

 private:
  line::LineSettings bench_, device_;
  int parity_ = 0, framing_ = 0;
};

}  // namespace fieldproof::probe::test
