#include "harness/probe/servers.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "harness/endpoints/emulator.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::probe {
namespace {

using endpoints::Endpoint;
using harness::Protocol;
using testing::ElementsAre;
using testing::HasSubstr;
using ServerKind = ServerFinding::Kind;

const Protocol& named(std::string_view name) { return *suites::protocols().find(name); }

/// The emulated device of one protocol, in simulated time, whoever is looked for.
NetworkOpener device(const std::string& protocol, const nlohmann::json& config) {
  return [=](const Protocol& wanted) -> Result<std::unique_ptr<Endpoint>> {
    auto endpoint = std::make_unique<endpoints::EmulatorEndpoint>(
        endpoints::EndpointName{"emulator", "xbc-h", {}},
        [&](std::string_view model, const nlohmann::json& of) {
          return named(protocol).make_device(model, of);
        },
        endpoints::Decorator{}, wanted.default_port());
    if (const Status begun = endpoint->begin(config); !begun) return begun.error();
    return std::unique_ptr<Endpoint>(std::move(endpoint));
  };
}

std::vector<ServerFinding> look(const NetworkOpener& open, std::string_view wanted) {
  const auto found = find_servers(open, {&named(wanted)}, suites::protocols(), 500ms);
  EXPECT_TRUE(found) << found.error().message;
  return found ? *found : std::vector<ServerFinding>();
}

TEST(Servers, AreFoundWithTheirLimits) {
  const auto fenet = look(device("xgt-fenet", {}), "xgt-fenet");
  ASSERT_EQ(fenet.size(), 2u) << "over TCP and UDP";
  for (const ServerFinding& one : fenet) {
    EXPECT_EQ(one.kind, ServerKind::server) << one.text;
    EXPECT_THAT(one.limits, ElementsAre("bytes of a continuous read: 512, as printed",
                                        "blocks of a read: 16, as printed"));
  }
  EXPECT_EQ(fenet[1].port, 2005);
  const auto modbus = look(device("modbus-tcp", {}), "modbus-tcp");
  ASSERT_EQ(modbus[0].kind, ServerKind::server) << modbus[0].text;
  EXPECT_THAT(modbus[0].limits, ElementsAre("words of a read (03): 125, as printed",
                                            "bits of a read (01): 2000, as printed"));
}

TEST(Servers, OfAnotherDriverRefuse) {
  const auto found = look(device("modbus-tcp", {}), "xgt-fenet");
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].kind, ServerKind::refused);
  EXPECT_THAT(found[0].advice, HasSubstr("one server driver"));
}

TEST(Servers, ThatTheHostTableKeepsUsFromAreNamed) {
  const auto found = look(device("xgt-fenet", {{"host_table", {"203.0.113.7"}}}), "xgt-fenet");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].kind, ServerKind::ended);
  EXPECT_EQ(found[1].kind, ServerKind::silent);
  for (const ServerFinding& one : found) EXPECT_THAT(one.advice, HasSubstr("host table"));
  EXPECT_THAT(found[0].advice, HasSubstr("most likely the host table"));
}

/// A bench whose other connections keep every channel.
class Taken final : public endpoints::EmulatorEndpoint {
 public:
  using EmulatorEndpoint::EmulatorEndpoint;
  Status take(int channels) {
    for (int i = 0; i < channels; ++i)
      if (const Result<LinkId> link = open(Transport::tcp, 0); !link) return link.error();
    return ok();
  }
};

TEST(Servers, WithoutAFreeChannelAnswerOverDatagrams) {
  const auto found = look(
      [](const Protocol& wanted) -> Result<std::unique_ptr<Endpoint>> {
        auto endpoint = std::make_unique<Taken>(
            endpoints::EndpointName{"emulator", "xbc-h", {}},
            [&](std::string_view model, const nlohmann::json& of) {
              return wanted.make_device(model, of);
            },
            endpoints::Decorator{}, wanted.default_port());
        Status ready = endpoint->begin(nlohmann::json::object());
        if (ready) ready = endpoint->take(4);
        if (!ready) return ready.error();
        return std::unique_ptr<Endpoint>(std::move(endpoint));
      },
      "xgt-fenet");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].kind, ServerKind::ended);
  EXPECT_THAT(found[0].advice, HasSubstr("all channels are taken"));
  EXPECT_THAT(found[0].advice, testing::Not(HasSubstr("lacks the address")));
  EXPECT_EQ(found[1].kind, ServerKind::server);
}

TEST(Servers, AreThoseOfNetworks) {
  EXPECT_TRUE(is_network_server(named("xgt-fenet")));
  EXPECT_TRUE(is_network_server(named("modbus-tcp")));
  EXPECT_FALSE(is_network_server(named("xgt-cnet")));
}

}  // namespace
}  // namespace fieldproof::probe
