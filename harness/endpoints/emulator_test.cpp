#include "harness/endpoints/emulator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <utility>

#include "harness/protocol.hpp"
#include "src/line/faults.hpp"

namespace fieldproof::endpoints::emulator_test {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Answers frames that begin with its station with ACK, station and its one byte of memory; "%FLAG"
/// makes it ask.
class TinyDevice : public plc::SerialDevice {
 public:
  explicit TinyDevice(int station) : station_(static_cast<Byte>(station)) {}

  void receive(const Burst& burst) override {
    if (burst.bytes.front() == station_) due_ = burst.end();
  }
  std::optional<Time> wake_at() const override { return due_; }
  Bytes advance(Time now) override {
    if (!due_ || *due_ > now) return {};
    due_.reset();
    return {0x06, station_, memory_};
  }
  Status set(std::string_view address, std::string_view hex) override {
    if (address == "%FLAG")
      due_ = Time{};
    else if (address != "%M" || hex.size() != 2)
      return fail("cannot set " + std::string(address) + ": no such memory");
    else
      memory_ = from_hex(hex)->front();
    return ok();
  }
  Result<std::string> get(std::string_view address, std::size_t) const override {
    if (address != "%M") return fail("cannot get " + std::string(address) + ": no such memory");
    return hex_number(memory_, 2);
  }
  Status act(std::string_view action) override {
    if (action != "power_cycle")
      return fail("cannot do " + std::string(action) + ": unknown action");
    memory_ = 0;
    return ok();
  }

 private:
  Byte station_;
  Byte memory_ = 0;
  std::optional<Time> due_;
};

/// What the factory was asked for.
struct Asked {
  std::string model;
  json config;
};
std::vector<Asked> asked;

Result<std::unique_ptr<plc::EmulatedDevice>> make_tiny(std::string_view model, const json& config) {
  asked.push_back({std::string(model), config});
  if (model != "tiny" && !model.empty()) return fail("unknown model '" + std::string(model) + "'");
  for (const auto& [key, value] : config.items()) {
    if (key != "station" && key != "line" && key != "rs485")
      return fail("unknown key '" + key + "'");
  }
  const json& station = config.at("station");
  return Result<std::unique_ptr<plc::EmulatedDevice>>(std::make_unique<TinyDevice>(
      station.is_string() ? std::stoi(station.get<std::string>()) : station.get<int>()));
}

class TinyProtocol : public harness::Protocol {
 public:
  std::string_view name() const override { return "tiny"; }
  std::vector<std::string> models() const override { return {"tiny"}; }
  Result<std::unique_ptr<plc::EmulatedDevice>> make_device(std::string_view model,
                                                           const json& config) const override {
    return make_tiny(model, config);
  }
  Bytes station_bytes(int station) const override { return {static_cast<Byte>(station)}; }
  std::optional<std::size_t> frame_length(ByteView bytes) const override { return bytes.size(); }
  std::vector<harness::Field> explain(ByteView) const override { return {}; }
  std::vector<Written> written_by(ByteView) const override { return {}; }
  std::vector<std::string_view> output_areas() const override { return {}; }
};

const TinyProtocol tiny_protocol;

const line::LineSettings n81{9600, 8, 'N', 1};
const Duration ct = n81.character_time();

EndpointName named(std::string_view text) {
  auto name = parse_endpoint(text);
  EXPECT_TRUE(name) << text;
  return *name;
}

class Emulator : public ::testing::Test {
 protected:
  Emulator() { asked.clear(); }

  std::unique_ptr<EmulatorEndpoint> open(std::string_view text, const json& config = json::object(),
                                         Decorator decorate = {}) {
    auto endpoint = std::make_unique<EmulatorEndpoint>(named(text), make_tiny, std::move(decorate));
    const Status begun = endpoint->begin(config);
    EXPECT_TRUE(begun) << (begun ? "" : begun.error().message);
    return endpoint;
  }
  static Bytes ask(Endpoint& endpoint, Bytes request) {
    const auto sent = endpoint.send(request);
    EXPECT_TRUE(sent);
    const auto reply = endpoint.receive(endpoint.now() + 1s);
    EXPECT_TRUE(reply);
    return reply->bytes;
  }
  static std::string refusal(std::string_view text, const json& config) {
    EmulatorEndpoint endpoint(named(text), make_tiny);
    const Status begun = endpoint.begin(config);
    return begun ? "accepted" : begun.error().message;
  }
};

TEST_F(Emulator, AnExchangeHasExactTimes) {
  auto endpoint = open("emulator:tiny");
  const auto sent = endpoint->send(Bytes{1, 2, 3, 4});
  ASSERT_TRUE(sent);
  EXPECT_EQ(sent->start, 0ns);
  EXPECT_EQ(sent->end, 4 * ct);
  const auto reply = endpoint->receive(1s);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->bytes, (Bytes{0x06, 1, 0}));
  EXPECT_EQ(reply->start, 4 * ct);
  EXPECT_EQ(endpoint->now(), 7 * ct);
  EXPECT_EQ(endpoint->character_time(), ct);
}

TEST_F(Emulator, SaysWhatItCan) {
  auto endpoint = open("emulator:tiny");
  const Capabilities& can = endpoint->capabilities();
  EXPECT_TRUE(can.simulated && can.wire && can.back_door && can.can_power_cycle);
  EXPECT_TRUE(can.connections && can.datagrams);
  EXPECT_FALSE(can.real_device);
  EXPECT_EQ(can.timing_floor, 0ns);
  EXPECT_EQ(endpoint->describe(), "emulator tiny");
}

TEST_F(Emulator, TheTargetIsTheModelElseTheCaseElseTheDefaultOfTheProtocol) {
  open("emulator:tiny", {{"model", "huge"}});
  open("emulator:", {{"model", "tiny"}});
  open("emulator:");
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_EQ(asked[0].model, "tiny");
  EXPECT_EQ(asked[1].model, "tiny");
  EXPECT_EQ(asked[2].model, "");
}

TEST_F(Emulator, OptionsAreDefaultsThatTheCaseOverrides) {
  open("emulator:tiny?station=3&line=19200-8E1&protocol=tiny",
       {{"station", 7}, {"bench_line", "9600"}, {"neighbours", json::array()}});
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].config, (json{{"station", 7}, {"line", "19200-8E1"}}));
  open("emulator:tiny?station=3");
  EXPECT_EQ(asked[1].config, (json{{"station", "3"}}));
  open("emulator:tiny");
  EXPECT_EQ(asked[2].config, (json{{"station", 1}}));
}

TEST_F(Emulator, EachCaseHasAFreshDeviceAndTimeGoesOn) {
  auto endpoint = open("emulator:tiny");
  ASSERT_TRUE(endpoint->set("%M", "5A"));
  EXPECT_EQ(ask(*endpoint, {1}), (Bytes{0x06, 1, 0x5A}));
  ASSERT_TRUE(endpoint->send(Bytes{1}));  // its reply is on the line when the next case begins
  const Time before = endpoint->now();
  ASSERT_TRUE(endpoint->begin(json::object()));
  EXPECT_EQ(endpoint->now(), before);
  EXPECT_TRUE(endpoint->receive(before + 1s)->bytes.empty());
  EXPECT_EQ(ask(*endpoint, {1}), (Bytes{0x06, 1, 0x00}));
  EXPECT_GT(endpoint->now(), before + 1s);
}

TEST_F(Emulator, TheBackDoorGoesToTheDevice) {
  auto endpoint = open("emulator:tiny");
  ASSERT_TRUE(endpoint->set("%M", "5A"));
  EXPECT_EQ(*endpoint->get("%M", 2), "5A");
  ASSERT_TRUE(endpoint->act("power_cycle"));
  EXPECT_EQ(*endpoint->get("%M", 2), "00");
  EXPECT_THAT(endpoint->set("%Z", "00").error().message, HasSubstr("%Z"));
  EXPECT_THAT(endpoint->get("%Z", 2).error().message, HasSubstr("%Z"));
  EXPECT_THAT(endpoint->act("explode").error().message, HasSubstr("explode"));
}

TEST_F(Emulator, ADeviceThatHasWorkAfterASetIsWokenAtOnce) {
  auto endpoint = open("emulator:tiny");
  (void)endpoint->receive(10ms);
  ASSERT_TRUE(endpoint->set("%FLAG", "01"));
  const auto request = endpoint->receive(1s);
  EXPECT_EQ(request->bytes, (Bytes{0x06, 1, 0}));
  EXPECT_EQ(request->start, 10ms);
}

TEST_F(Emulator, NeighboursShareTheLine) {
  auto endpoint = open("emulator:tiny", {{"line", "19200-8N1"},
                                         {"neighbours", {2, {{"station", 3}, {"line", "9600"}}}}});
  EXPECT_EQ(asked.size(), 3u);
  EXPECT_EQ(ask(*endpoint, {1}), (Bytes{0x06, 1, 0}));
  EXPECT_EQ(ask(*endpoint, {2}), (Bytes{0x06, 2, 0}));
  EXPECT_EQ(ask(*endpoint, {3}), (Bytes{}));  // at another speed
}

TEST_F(Emulator, NeighboursCanBeAnOption) {
  auto endpoint = open("emulator:tiny?neighbours=[2,5]");
  EXPECT_EQ(ask(*endpoint, {5}), (Bytes{0x06, 5, 0}));
}

TEST_F(Emulator, TheBenchMayHaveSettingsOfItsOwn) {
  auto endpoint = open("emulator:tiny", {{"line", "9600-8E1"}, {"bench_line", "9600-8N1"}});
  EXPECT_EQ(endpoint->character_time(), ct);
  // The stop bit of the request passes as the parity of 01. Of the reply 06 01 00 the parity bits 0
  // 1 0 stand where the bench expects its stop bit.
  EXPECT_EQ(ask(*endpoint, {1}), (Bytes{0x01}));
  EXPECT_TRUE(endpoint->receive(1s)->bytes.empty());
  EXPECT_EQ(endpoint->line_errors(), "2 framing errors");
  EXPECT_EQ(endpoint->line_errors(), "");
}

TEST_F(Emulator, Rs485IsHalfDuplex) {
  for (const bool rs485 : {false, true}) {
    auto endpoint = open("emulator:tiny", {{"rs485", rs485}});
    ASSERT_TRUE(endpoint->send(Bytes{1}));
    ASSERT_TRUE(endpoint->send(Bytes{9, 9, 9, 9}));  // while the reply comes
    EXPECT_EQ(endpoint->receive(1s)->bytes.empty(), rs485);
  }
}

TEST_F(Emulator, ADecoratorStandsBetweenLineAndDevice) {
  auto endpoint = open("emulator:tiny", {{"neighbours", {2}}},
                       [](line::Device& device, const line::LineSettings& line) {
                         return std::make_unique<line::FaultyDevice>(
                             device, line::LineFaults{.reply = {.flip = 0}}, line.character_time());
                       });
  EXPECT_EQ(ask(*endpoint, {1}), (Bytes{0x07, 1, 0}));
  EXPECT_EQ(ask(*endpoint, {2}), (Bytes{0x06, 2, 0}));  // the device under test alone
}

TEST_F(Emulator, ErrorsNameTheKey) {
  EXPECT_THAT(refusal("emulator:tiny", {{"line", 9600}}), HasSubstr("'line' is 9600"));
  EXPECT_THAT(refusal("emulator:tiny", {{"line", "9601"}}), HasSubstr("9601"));
  EXPECT_THAT(refusal("emulator:tiny", {{"bench_line", true}}), HasSubstr("'bench_line' is true"));
  EXPECT_THAT(refusal("emulator:tiny", {{"neighbours", 2}}), HasSubstr("'neighbours' is 2"));
  EXPECT_THAT(refusal("emulator:tiny", {{"neighbours", {{{"statoin", 2}, {"station", 3}}}}}),
              HasSubstr("unknown key 'statoin'"));
  EXPECT_THAT(refusal("emulator:tiny", {{"colour", "red"}}), HasSubstr("unknown key 'colour'"));
  EXPECT_THAT(refusal("emulator:huge", json::object()), HasSubstr("unknown model 'huge'"));
}

TEST_F(Emulator, WithoutADeviceEverythingIsRefused) {
  EmulatorEndpoint endpoint(named("emulator:huge"), make_tiny);
  ASSERT_FALSE(endpoint.begin(json::object()));
  EXPECT_THAT(endpoint.send(Bytes{1}).error().message, HasSubstr("cannot send"));
  EXPECT_THAT(endpoint.receive(1s).error().message, HasSubstr("cannot receive"));
  EXPECT_THAT(endpoint.set("%M", "00").error().message, HasSubstr("cannot set %M"));
  EXPECT_THAT(endpoint.get("%M", 2).error().message, HasSubstr("cannot look at %M"));
  EXPECT_THAT(endpoint.act("stop").error().message, HasSubstr("cannot do stop"));
}

TEST_F(Emulator, OpensByTheTable) {
  const auto endpoint =
      open_endpoint(named("emulator:tiny?protocol=tiny&station=4"), tiny_protocol);
  ASSERT_TRUE(endpoint) << endpoint.error().message;
  EXPECT_EQ(ask(**endpoint, {4}), (Bytes{0x06, 4, 0}));
}

TEST_F(Emulator, OpeningReportsAWrongModelOrOption) {
  const auto message = [](std::string_view text) {
    const auto endpoint = open_endpoint(named(text), tiny_protocol);
    return endpoint ? std::string("opened") : endpoint.error().message;
  };
  EXPECT_EQ(message("emulator:huge?protocol=tiny"),
            "cannot open emulator:huge: unknown model 'huge'");
  EXPECT_EQ(message("emulator:tiny?protocol=tiny&colour=red"),
            "cannot open emulator:tiny: unknown key 'colour'");
}

/// Answers each segment at once on its link, and a FIN with a FIN.
class TinyHost : public net::Host {
 public:
  bool listens(Transport transport, std::uint16_t port) const override {
    return transport == Transport::tcp && port == 502;
  }
  void receive(const Burst& burst) override {
    now_ = burst.start;
    if (burst.event == LinkEvent::data) does_.push_back({.bytes = {0x55}, .link = burst.link});
    if (burst.event == LinkEvent::closed)
      does_.push_back({.bytes = {}, .link = burst.link, .event = LinkEvent::closed});
  }
  std::optional<Time> wake_at() const override {
    return does_.empty() ? std::nullopt : std::optional(now_);
  }
  std::vector<Burst> advance(Time) override { return std::exchange(does_, {}); }

 private:
  Time now_{};
  std::vector<Burst> does_;
};

/// Two lines and a network.
class ThreeWays : public plc::EmulatedDevice {
 public:
  line::Device* line(unsigned channel) override {
    return channel == 2 ? &second_ : channel < 2 ? &first_ : nullptr;
  }
  net::Host* network() override { return &host_; }
  Status set(std::string_view address, std::string_view hex) override {
    return first_.set(address, hex);
  }
  Result<std::string> get(std::string_view address, std::size_t digits) const override {
    return first_.get(address, digits);
  }
  Status act(std::string_view action) override { return first_.act(action); }

 private:
  TinyDevice first_{1}, second_{2};
  TinyHost host_;
};

struct EmulatorOnNetwork : Emulator {
  EmulatorEndpoint endpoint{
      named("emulator:"),
      [](std::string_view, const json&) {
        return Result<std::unique_ptr<plc::EmulatedDevice>>(std::make_unique<ThreeWays>());
      },
      {},
      502};
  EmulatorOnNetwork() { EXPECT_TRUE(endpoint.begin(json::object())); }
};

TEST_F(EmulatorOnNetwork, LinksAreApart) {
  const Result<LinkId> a = endpoint.open(Transport::tcp, 0), b = endpoint.open(Transport::tcp, 502);
  ASSERT_TRUE(a && b);
  ASSERT_TRUE(endpoint.send(Bytes{1}, *b));
  const auto answer = endpoint.receive(endpoint.now() + 1s);
  EXPECT_EQ(answer->link, *b);
  EXPECT_EQ(answer->bytes, Bytes{0x55});
  ASSERT_TRUE(endpoint.close(*a, Closing::fin));
  const auto end = endpoint.receive(endpoint.now() + 1s);
  EXPECT_EQ(end->link, *a);
  EXPECT_EQ(end->event, LinkEvent::closed);
  EXPECT_FALSE(endpoint.send(Bytes{1}, *a));
}

TEST_F(EmulatorOnNetwork, APortThatDoesNotListenRefuses) {
  const Result<LinkId> link = endpoint.open(Transport::tcp, 503);
  ASSERT_TRUE(link);
  EXPECT_EQ(endpoint.receive(endpoint.now() + 1s)->event, LinkEvent::reset);
}

TEST_F(EmulatorOnNetwork, LinesAndNetworkRunInStep) {
  const Result<LinkId> link = endpoint.open(Transport::tcp, 0);
  const Result<LinkId> second = endpoint.open_line(2);
  ASSERT_TRUE(link && second);
  ASSERT_TRUE(endpoint.send(Bytes{2}, *second));
  const Time sent = endpoint.now();
  EXPECT_EQ(sent, ct) << "on a line, sending takes time";
  ASSERT_TRUE(endpoint.send(Bytes{7}, *link));
  EXPECT_EQ(endpoint.now(), sent) << "on a network it takes none";
  ASSERT_TRUE(endpoint.send(Bytes{1}));  // while both are answering
  std::map<LinkId, Bytes> heard;
  for (Result<Burst> burst = endpoint.receive(1s); !burst->bytes.empty();
       burst = endpoint.receive(1s))
    heard[burst->link].insert(heard[burst->link].end(), burst->bytes.begin(), burst->bytes.end());
  EXPECT_EQ(heard[*link], Bytes{0x55});
  EXPECT_EQ(heard[*second], (Bytes{0x06, 2, 0}));
  EXPECT_EQ(heard[line_link], (Bytes{0x06, 1, 0}));
  EXPECT_EQ(endpoint.now(), 1s);
}

TEST_F(EmulatorOnNetwork, WhatIsNotThereIsNamed) {
  EXPECT_THAT(endpoint.open_line(3).error().message, HasSubstr("channel 3"));
  auto serial = open("emulator:tiny");
  EXPECT_THAT(serial->open(Transport::tcp, 502).error().message, HasSubstr("is on no network"));
  EXPECT_THAT(serial->send(Bytes{1}, 7).error().message, HasSubstr("link 7"));
}

}  // namespace
}  // namespace fieldproof::endpoints::emulator_test
