#include "src/net/network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "src/net/test_echo_host.hpp"

namespace fieldproof::net {
namespace {

using test::EchoHost;

constexpr std::uint16_t echo_port = 7;

class Network : public testing::Test {
 protected:
  void connect_to(const Conditions& conditions) {
    network_.emplace(conditions);
    network_->attach(host);
  }
  SimulatedNetwork& network() {
    if (!network_) connect_to({});
    return *network_;
  }
  LinkId open(Transport transport = Transport::tcp) { return network().open(transport, echo_port); }
  void say(LinkId link, std::string_view text) {
    const Result<Sent> sent = network().send(link, to_bytes(text));
    ASSERT_TRUE(sent) << sent.error().message;
  }
  /// All that the bench hears until `until`, as "1:text" or "1:closed".
  std::vector<std::string> heard(Time until) {
    std::vector<std::string> all;
    for (;;) {
      const Burst burst = network().receive(until);
      if (burst.event == LinkEvent::data && burst.bytes.empty()) return all;
      all.push_back(shown(burst));
    }
  }
  static std::string shown(const Burst& burst) {
    const std::string link = burst.link >= first_own_link
                                 ? "own" + std::to_string(burst.link - first_own_link)
                                 : std::to_string(burst.link);
    switch (burst.event) {
      case LinkEvent::opened: return link + ":opened " + std::to_string(burst.port);
      case LinkEvent::closed: return link + ":closed";
      case LinkEvent::reset: return link + ":reset";
      case LinkEvent::data:
      case LinkEvent::datagram: break;
    }
    return link + ":" + to_text(burst.bytes);
  }
  using Heard = std::vector<std::string>;

  EchoHost host;

 private:
  std::optional<SimulatedNetwork> network_;
};

TEST_F(Network, AConnectionIsSetUpAndCarriesBytesBothWays) {
  const LinkId link = open();
  ASSERT_EQ(host.heard.size(), 1u);
  EXPECT_EQ(host.heard[0].event, LinkEvent::opened);
  EXPECT_EQ(host.heard[0].port, echo_port);
  EXPECT_EQ(host.heard[0].peer, "127.0.0.1:49153");
  say(link, "one");
  EXPECT_EQ(heard(0s), (Heard{"1:one"}));
  EXPECT_EQ(network().now(), Time{});
}

TEST_F(Network, APortWhereNobodyListensRefuses) {
  const LinkId link = network().open(Transport::tcp, 8);
  EXPECT_EQ(heard(1s), (Heard{"1:reset"}));
  EXPECT_TRUE(host.heard.empty());
  EXPECT_TRUE(network().send(link, Bytes{1}));  // lost
  EXPECT_EQ(heard(2s), Heard{});
  EXPECT_TRUE(host.heard.empty());
}

TEST_F(Network, BytesBeforeAConnectionStandsWaitForIt) {
  connect_to({.delay = 5ms});
  const LinkId link = open();
  EXPECT_TRUE(host.heard.empty());
  say(link, "early");
  EXPECT_EQ(heard(1s), (Heard{"1:early"}));
  EXPECT_EQ(host.heard_of(LinkEvent::opened), ",");
}

TEST_F(Network, SilenceCostsNothingAndTimesAreExact) {
  connect_to({.delay = 3ms});
  host.think = 1h;
  const LinkId link = open();
  say(link, "slow");
  const Burst reply = network().receive(2h);
  EXPECT_EQ(to_text(reply.bytes), "slow");
  EXPECT_EQ(reply.start, 1h + 6ms);
  EXPECT_EQ(reply.end(), reply.start);
  EXPECT_EQ(network().now(), 1h + 6ms);
  const Burst none = network().receive(2h);
  EXPECT_TRUE(none.bytes.empty());
  EXPECT_EQ(none.event, LinkEvent::data);
  EXPECT_EQ(network().now(), 2h);
  (void)network().receive(1s);  // time does not go back
  EXPECT_EQ(network().now(), 2h);
}

TEST_F(Network, FinClosesOneWayAlone) {
  host.think = 10ms;
  const LinkId link = open();
  say(link, "last");
  ASSERT_TRUE(network().close(link, Closing::fin));
  EXPECT_EQ(host.heard.back().event, LinkEvent::closed);
  EXPECT_EQ(heard(1s), (Heard{"1:last"}));  // the other way still carries
  EXPECT_FALSE(network().send(link, Bytes{1}));
}

TEST_F(Network, TheHostClosesItsWayAloneToo) {
  const LinkId link = open();
  say(link, "bye");
  EXPECT_EQ(heard(1s), (Heard{"1:closed"}));
  say(link, "still heard");
  EXPECT_EQ(heard(2s), Heard{});  // its echo is lost: the host has closed
  EXPECT_EQ(host.heard_of(LinkEvent::data), "bye,still heard,");
}

TEST_F(Network, RstOfTheBenchEndsTheLinkAtOnce) {
  host.think = 10ms;
  const LinkId link = open();
  say(link, "lost");
  ASSERT_TRUE(network().close(link, Closing::rst));
  EXPECT_EQ(host.heard.back().event, LinkEvent::reset);
  EXPECT_EQ(heard(1s), Heard{});
  EXPECT_EQ(network().send(link, Bytes{1}).error().message,
            "cannot send on link 1: it is not open");
  EXPECT_EQ(network().close(link, Closing::fin).error().message,
            "cannot close link 1: it is not open");
  EXPECT_EQ(network().close(99, Closing::fin).error().message,
            "cannot close link 99: it is not open");
}

TEST_F(Network, RstOfTheHostEndsTheLink) {
  const LinkId link = open();
  say(link, "rst");
  say(link, "never heard");
  EXPECT_EQ(heard(1s), (Heard{"1:reset"}));
  EXPECT_EQ(host.heard_of(LinkEvent::data), "rst,");
}

TEST_F(Network, RstOvertakesNoBytes) {
  connect_to({.delay = 1ms, .jitter = 5ms});
  const LinkId link = open();
  say(link, "before");
  say(link, "rst");
  EXPECT_EQ(heard(1s), (Heard{"1:before", "1:reset"}));
}

TEST_F(Network, AClientThatVanishesIsSilent) {
  host.think = 10ms;
  const LinkId link = open(), other = open();
  say(link, "asked");
  ASSERT_TRUE(network().close(link, Closing::vanish));
  say(other, "here");
  EXPECT_EQ(heard(1s), (Heard{"2:here"}));
  // The host is told nothing.
  EXPECT_EQ(host.heard_of(LinkEvent::closed) + host.heard_of(LinkEvent::reset), "");
  EXPECT_FALSE(network().send(link, Bytes{1}));
}

TEST_F(Network, ClientsDoNotDisturbEachOther) {
  const LinkId a = open(), b = open(), c = open();
  say(b, "of b");
  say(a, "of a");
  ASSERT_TRUE(network().close(b, Closing::rst));
  say(c, "of c");
  EXPECT_EQ(heard(1s), (Heard{"1:of a", "3:of c"}));
  std::set<std::string> peers;
  for (const Burst& burst : host.heard)
    if (burst.event == LinkEvent::opened) peers.insert(burst.peer);
  EXPECT_EQ(peers.size(), 3u);
}

TEST_F(Network, TheHostConnectsToTheBench) {
  const LinkId link = open();
  say(link, "call");
  EXPECT_EQ(heard(1s), (Heard{"own0:opened 9", "own0:hello"}));
  say(first_own_link, "welcome");
  EXPECT_EQ(heard(1s), (Heard{"own0:welcome"}));
  ASSERT_TRUE(network().close(first_own_link, Closing::fin));
  EXPECT_EQ(host.heard.back().event, LinkEvent::closed);
  EXPECT_EQ(host.heard.back().link, first_own_link);
}

TEST_F(Network, TheBenchMayRefuseTheHost) {
  const LinkId link = open();
  network().take_connections(false);
  say(link, "call");
  EXPECT_EQ(heard(1s), Heard{});
  EXPECT_EQ(host.heard.back().event, LinkEvent::reset);
  EXPECT_EQ(host.heard.back().link, first_own_link);
}

TEST_F(Network, DatagramsAreWholeAndAnsweredToTheirSender) {
  const LinkId a = open(Transport::udp), b = open(Transport::udp);
  say(b, "from b");
  say(a, "");
  ASSERT_EQ(host.heard.size(), 2u);
  EXPECT_EQ(host.heard[0].event, LinkEvent::datagram);
  EXPECT_EQ(host.heard[0].port, echo_port);
  EXPECT_NE(host.heard[0].peer, host.heard[1].peer);
  const Burst first = network().receive(1s), second = network().receive(1s);
  EXPECT_EQ(shown(first), "2:from b");
  EXPECT_EQ(second.link, a);
  EXPECT_EQ(second.event, LinkEvent::datagram);
  EXPECT_EQ(second.port, echo_port);
  EXPECT_TRUE(second.bytes.empty());
}

TEST_F(Network, ADatagramToAPortWhereNobodyListensIsLost) {
  say(network().open(Transport::udp, 8), "hello");
  EXPECT_TRUE(host.heard.empty());
  EXPECT_EQ(heard(1s), Heard{});
}

TEST_F(Network, TheHostSendsDatagramsOfItsOwn) {
  say(open(Transport::udp), "tell");
  EXPECT_EQ(heard(1s), (Heard{"own0:hello"}));
  say(first_own_link, "thanks");
  EXPECT_EQ(heard(1s), (Heard{"own0:thanks"}));
}

TEST_F(Network, SegmentsAreCutByTheSeed) {
  const std::string text(200, 'x');
  std::set<std::size_t> counts;
  for (const std::uint64_t seed : {1, 1, 2, 3}) {
    host.heard.clear();
    connect_to({.seed = seed, .cut = 0.2});
    say(open(), text);
    const std::string got = host.heard_of(LinkEvent::data);
    EXPECT_EQ(std::ranges::count(got, 'x'), 200);
    const auto pieces = static_cast<std::size_t>(std::ranges::count(got, ','));
    EXPECT_GT(pieces, 10u);
    counts.insert(pieces);
    std::size_t echoed = 0;
    for (const std::string& piece : heard(1s)) echoed += piece.size() - 2;
    EXPECT_EQ(echoed, 200u);
  }
  EXPECT_GT(counts.size(), 1u);
  EXPECT_LE(counts.size(), 3u);  // the same seed, the same pieces
}

TEST_F(Network, SegmentsAreJoinedWhereTheyArriveTogether) {
  connect_to({.delay = 1ms, .join = 1});
  const LinkId a = open(), b = open();
  say(a, "one,");
  say(a, "two,");
  say(b, "other,");
  say(a, "three,");
  EXPECT_EQ(heard(10ms), (Heard{"1:one,two,", "2:other,", "1:three,"}));
  ASSERT_TRUE(network().close(a, Closing::fin));
  EXPECT_EQ(heard(1s), Heard{});
  EXPECT_EQ(host.heard.back().event, LinkEvent::closed);  // joined with nothing
}

TEST_F(Network, AStreamKeepsItsOrderWhateverTheJitter) {
  connect_to({.seed = 7, .delay = 1ms, .jitter = 20ms, .cut = 0.5, .join = 0.5});
  const LinkId link = open();
  std::string text;
  for (char c = 'a'; c <= 'z'; ++c) {
    say(link, std::string(3, c));
    text += std::string(3, c);
    (void)network().run(network().now() + 1ms);
  }
  std::string all;
  for (const std::string& piece : heard(10s)) all += piece.substr(2);
  EXPECT_EQ(all, text);
}

TEST_F(Network, DatagramsAreLostDoubledAndOvertakenByTheSeed) {
  const auto run = [this](const Conditions& conditions) {
    host.heard.clear();
    connect_to(conditions);
    const LinkId link = open(Transport::udp);
    for (char c = 'a'; c <= 'z'; ++c) {
      say(link, std::string(1, c));
      network().run(network().now() + 1ms);
    }
    (void)heard(1s);
    std::string got = host.heard_of(LinkEvent::datagram);
    std::erase(got, ',');
    return got;
  };
  const std::string all = "abcdefghijklmnopqrstuvwxyz";
  EXPECT_EQ(run({}), all);
  const std::string lossy = run({.lost = 0.3});
  EXPECT_LT(lossy.size(), all.size());
  EXPECT_TRUE(std::ranges::includes(all, lossy));
  EXPECT_EQ(run({.lost = 0.3}), lossy);
  EXPECT_NE(run({.seed = 2, .lost = 0.3}), lossy);

  std::string twice = run({.doubled = 0.3});
  EXPECT_GT(twice.size(), all.size());
  twice.erase(std::unique(twice.begin(), twice.end()), twice.end());
  EXPECT_EQ(twice, all);

  std::string mixed = run({.late = 0.3, .lateness = 5ms});
  EXPECT_NE(mixed, all);
  std::ranges::sort(mixed);
  EXPECT_EQ(mixed, all);
}

TEST_F(Network, AHostThatNeverComesToRestIsAFault) {
  class Restless : public EchoHost {
   public:
    std::optional<Time> wake_at() const override { return Time{}; }
  } restless;
  SimulatedNetwork own;
  own.attach(restless);
  EXPECT_THROW((void)own.receive(1s), std::logic_error);
}

TEST_F(Network, AHostThatUsesALinkThatNeverWasIsAFault) {
  host.will_do(1ms, {.bytes = {1}, .link = 5});
  (void)network().now();
  EXPECT_THROW((void)network().receive(1s), std::logic_error);
}

}  // namespace
}  // namespace fieldproof::net
