#include "src/plc/ethernet.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace fieldproof::plc {
namespace {

/// Does what it is told to.
class Told : public NetworkService {
 public:
  std::vector<Port> ports() const override { return {{Transport::tcp, 502}}; }
  const ServiceCounters& counters() const override { return counters_; }
  void power_cycle() override {}
  void receive(const Burst&) override { ++heard; }
  std::optional<Time> wake_at() const override { return std::nullopt; }
  std::vector<Burst> advance(Time) override { return std::exchange(does, {}); }

  std::vector<Burst> does;
  int heard = 0;

 private:
  ServiceCounters counters_;
};

/// What is known of links goes with them: in whatever way a connection ends.
class EthernetLinks : public testing::Test {
 protected:
  EthernetLinks() {
    if (!ethernet.add(service)) ADD_FAILURE();
  }
  static Burst on(LinkId link, LinkEvent event) {
    return {.bytes = {}, .start = {}, .link = link, .event = event, .port = 502};
  }
  void client(LinkId link, LinkEvent event) { ethernet.receive(on(link, event)); }
  void we(LinkId link, LinkEvent event) {
    service.does.push_back(on(link, event));
    EXPECT_EQ(ethernet.advance({}).size(), 1u);
  }

  Told service;
  Ethernet ethernet;
};

TEST_F(EthernetLinks, GoWithAResetByEitherSide) {
  for (LinkId link = 1; link < 100; link += 2) {
    client(link, LinkEvent::opened);
    client(link, LinkEvent::reset);
    client(link + 1, LinkEvent::opened);
    we(link + 1, LinkEvent::reset);
  }
  EXPECT_EQ(ethernet.links(), 0u);
  EXPECT_EQ(service.heard, 150) << "all of it was for the service";
}

// FEnet EN 6.2.2 (3): 'only the clients who have the registered IP address'.
TEST_F(EthernetLinks, OfAddressesThatTheHostTableLacksReachNoService) {
  ethernet.allow_only({"192.0.2.1", "192.0.2.2"});
  const auto from = [&](LinkId link, LinkEvent event, const char* peer) {
    Burst burst = on(link, event);
    burst.peer = peer;
    ethernet.receive(burst);
    return ethernet.advance({});
  };
  EXPECT_EQ(from(1, LinkEvent::opened, "192.0.2.1:5000").size(), 0u);
  EXPECT_EQ(service.heard, 1);
  const std::vector<Burst> refused = from(2, LinkEvent::opened, "192.0.2.11:5000");
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].event, LinkEvent::reset);
  EXPECT_EQ(refused[0].link, 2u);
  EXPECT_EQ(from(2, LinkEvent::data, "").size(), 0u);
  EXPECT_EQ(from(3, LinkEvent::datagram, "192.0.2.11:5000").size(), 0u);
  EXPECT_EQ(service.heard, 1) << "nothing of them";
  client(1, LinkEvent::data);
  EXPECT_EQ(service.heard, 2);
}

TEST_F(EthernetLinks, GoWhenBothSidesHaveClosed) {
  client(1, LinkEvent::opened);
  client(1, LinkEvent::closed);
  EXPECT_EQ(ethernet.links(), 1u) << "we may still send";
  we(1, LinkEvent::closed);
  EXPECT_EQ(ethernet.links(), 0u);
  we(first_own_link, LinkEvent::opened);
  we(first_own_link, LinkEvent::closed);
  client(first_own_link, LinkEvent::data);
  EXPECT_EQ(service.heard, 3) << "the partner may still send";
  client(first_own_link, LinkEvent::closed);
  EXPECT_EQ(ethernet.links(), 0u);
}

}  // namespace
}  // namespace fieldproof::plc
