#include "src/plc/plc.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/net/network.hpp"

namespace fieldproof::plc {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// Writes what it hears into %MW0, says what it is told to, and notes what happens to it.
template <typename Base>
class Noting : public Base {
 public:
  Noting(PlcMemory& memory, std::string& notes) : memory_(memory), notes_(notes) {}

  const ServiceCounters& counters() const override { return counters_; }
  void power_cycle() override { notes_ += "power "; }
  void set_run(bool run) override { notes_ += run ? "run " : "stop "; }
  void scan() override { notes_ += "scan "; }

 protected:
  void hear(const Burst& burst) {
    counters_.count_service();
    if (burst.bytes.empty()) return;
    memory_.write(parse_address(memory_.model(), "%MW0").address, burst.bytes.front());
    memory_.written();
  }

  PlcMemory& memory_;
  std::string& notes_;
  ServiceCounters counters_;
};

class LineNoter : public Noting<LineService> {
 public:
  using Noting::Noting;
  void receive(const Burst& burst) override { hear(burst); }
  std::optional<Time> wake_at() const override { return std::nullopt; }
  Bytes advance(Time) override { return {}; }
  std::vector<std::string> actions() const override { return {"wink"}; }
  std::optional<Status> act(std::string_view action) override {
    if (action != "wink") return std::nullopt;
    notes_ += "wink ";
    return ok();
  }
};

/// Answers what it hears; "call" makes it connect to the bench.
class NetNoter : public Noting<NetworkService> {
 public:
  NetNoter(PlcMemory& memory, std::string& notes, std::uint16_t port, net::OwnLinks& links)
      : Noting(memory, notes), port_(port), links_(links) {}
  std::vector<Port> ports() const override {
    return {{Transport::tcp, port_}, {Transport::udp, port_}};
  }
  void receive(const Burst& burst) override {
    hear(burst);
    notes_ += std::to_string(port_) + ":" + to_text(burst.bytes) + " ";
    if (to_text(burst.bytes) == "call")
      doings_.push_back({.bytes = {},
                         .start = burst.start,
                         .link = links_.next(),
                         .event = LinkEvent::opened,
                         .port = 9,
                         .peer = {}});
    else if (!burst.bytes.empty())
      doings_.push_back({.bytes = to_bytes(std::to_string(port_)), .link = burst.link});
  }
  std::optional<Time> wake_at() const override {
    return doings_.empty() ? std::nullopt : std::optional<Time>(Time{});
  }
  std::vector<Burst> advance(Time) override { return std::exchange(doings_, {}); }

 private:
  std::uint16_t port_;
  net::OwnLinks& links_;
  std::vector<Burst> doings_;
};

class PlcTest : public testing::Test {
 protected:
  Status add_line(unsigned channel) {
    return plc.add(channel, std::make_unique<LineNoter>(plc.memory(), notes));
  }
  Status add_network(std::uint16_t port) {
    return plc.add(std::make_unique<NetNoter>(plc.memory(), notes, port, plc.own_links()));
  }
  std::string noted() { return std::exchange(notes, {}); }

  std::string notes;
  Plc plc{plc_models().front()};
};

TEST_F(PlcTest, HasWhatWasAdded) {
  EXPECT_EQ(plc.line(), nullptr);
  EXPECT_EQ(plc.network(), nullptr);
  ASSERT_TRUE(add_line(2));
  EXPECT_NE(plc.line(2), nullptr);
  EXPECT_EQ(plc.line(), plc.line(2)) << "the first that is added is the main one";
  EXPECT_EQ(plc.line(1), nullptr);
  EXPECT_EQ(plc.network(), nullptr);
  ASSERT_TRUE(add_network(502));
  EXPECT_TRUE(plc.network()->listens(Transport::tcp, 502));
  EXPECT_FALSE(plc.network()->listens(Transport::tcp, 503));
  EXPECT_THAT(add_line(2).error().message, HasSubstr("channel 2"));
  EXPECT_THAT(add_network(502).error().message, HasSubstr("two services on TCP port 502"));
}

TEST_F(PlcTest, WithoutAServiceNothingIsCounted) {
  EXPECT_THAT(plc.get("@services", 0).error().message, HasSubstr("has no service"));
}

TEST_F(PlcTest, ServicesShareOneMemoryAndHearOfItsChanges) {
  ASSERT_TRUE(add_line(1));
  ASSERT_TRUE(add_network(502));
  noted();
  plc.line()->receive({.bytes = {0x12}});
  EXPECT_EQ(noted(), "scan scan ");
  EXPECT_EQ(*plc.get("%MW0", 0), "0012");
  ASSERT_TRUE(plc.set("%MW1", "5ABC"));
  EXPECT_EQ(noted(), "scan scan ");
  EXPECT_FALSE(plc.set("%ZW1", "5ABC"));
  EXPECT_EQ(noted(), "");
}

TEST_F(PlcTest, ModeAndPowerAreThoseOfAll) {
  ASSERT_TRUE(add_line(1));
  ASSERT_TRUE(add_network(502));
  EXPECT_EQ(noted(), "run run ");
  ASSERT_TRUE(plc.act("stop"));
  EXPECT_EQ(noted(), "stop stop ");
  ASSERT_TRUE(add_line(2));
  EXPECT_EQ(noted(), "stop ") << "a service is told the mode when it is added";
  ASSERT_TRUE(plc.act("run"));
  ASSERT_TRUE(plc.act("power_cycle"));
  EXPECT_EQ(noted(), "run run run power power power ");
}

TEST_F(PlcTest, ActionsOfServices) {
  ASSERT_TRUE(add_network(502));
  EXPECT_EQ(plc.act("wink").error().message,
            "cannot do 'wink': there is no such action; use run, stop or power_cycle");
  ASSERT_TRUE(add_line(1));
  ASSERT_TRUE(add_line(2));
  noted();
  ASSERT_TRUE(plc.act("wink"));
  EXPECT_EQ(noted(), "wink wink ");
  EXPECT_EQ(plc.act("wnk").error().message,
            "cannot do 'wnk': there is no such action; use one of run, stop, power_cycle, wink; "
            "did you mean 'wink'?");
}

TEST_F(PlcTest, CountersAreThoseOfTheMainService) {
  ASSERT_TRUE(add_line(1));
  ASSERT_TRUE(add_line(2));
  plc.line(2)->receive({.bytes = {1}});
  EXPECT_EQ(*plc.get("@services", 0), "0000");
  plc.line(1)->receive({.bytes = {1}});
  EXPECT_EQ(*plc.get("@services", 0), "0001");
}

TEST_F(PlcTest, ServicesOfTheEthernetModuleShareItsNetwork) {
  ASSERT_TRUE(add_network(502));
  ASSERT_TRUE(add_network(2004));
  net::SimulatedNetwork network;
  network.attach(*plc.network());
  const LinkId a = network.open(Transport::tcp, 2004), b = network.open(Transport::tcp, 502),
               none = network.open(Transport::tcp, 80);
  EXPECT_EQ(network.receive(1s).link, none) << "refused";
  noted();
  ASSERT_TRUE(network.send(a, to_bytes("x")));
  ASSERT_TRUE(network.send(b, to_bytes("y")));
  EXPECT_EQ(to_text(network.receive(2s).bytes), "2004");
  EXPECT_EQ(to_text(network.receive(2s).bytes), "502");
  EXPECT_EQ(noted(), "scan scan 2004:x scan scan 502:y ");

  ASSERT_TRUE(network.send(a, to_bytes("call")));
  ASSERT_TRUE(network.send(b, to_bytes("call")));
  const Burst first = network.receive(3s), second = network.receive(3s);
  EXPECT_NE(first.link, second.link);
  noted();
  ASSERT_TRUE(network.send(second.link, to_bytes("z")));
  EXPECT_EQ(noted(), "scan scan 502:z ") << "what was opened by one stays with it";
}

TEST(MakePlc, ErrorsNameTheModelOrTheMode) {
  EXPECT_TRUE(make_plc("xec-h", json::object()));
  EXPECT_THAT(make_plc("xbc_h", json::object()).error().message, HasSubstr("did you mean 'xbc-h'"));
  EXPECT_THAT(make_plc("xbc-h", {{"mode", "pause"}}).error().message,
              HasSubstr("mode is 'pause', which is not run or stop"));
}

}  // namespace
}  // namespace fieldproof::plc
