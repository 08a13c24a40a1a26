// A client that was written from the manual alone, by a second hand in another language, against
// the emulator in a process of its own.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "suites/modbus/peers/test_ports.hpp"
#include "suites/tool/tool.hpp"

namespace fieldproof::fenet_peers {
namespace {

using modbus_peers::free_port;
using nlohmann::json;
using tool_tests::Finished;

const std::string folder = FIELDPROOF_SOURCE_DIR "/suites/xgt_fenet/peers/";

std::string on_loopback(std::uint16_t port) { return fmt::format("127.0.0.1:{}", port); }

class EmulatedPlc {
 public:
  explicit EmulatedPlc(const std::string& options = "")
      : emulator_(tool_tests::tool_arguments(
            {"emulate", "xbc-h?protocol=xgt-fenet" + options, "--tcp", tcp_, "--udp", udp_})) {
    EXPECT_TRUE(emulator_.wait_for(tcp_));
  }

  /// What the client says of it.
  Finished checked() const {
    return tool_tests::run_program(
        {"/usr/bin/python3", "-B", folder + "fenet_check.py", "--tcp", tcp_, "--udp", udp_});
  }
  Finished loaded(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"/usr/bin/python3", "-B", folder + "fenet_load.py"});
    arguments.insert(arguments.end(), {"--tcp", tcp_});
    return tool_tests::run_program(arguments);
  }

  std::size_t descriptors() const {
    const std::filesystem::directory_iterator open(fmt::format("/proc/{}/fd", emulator_.id()));
    return static_cast<std::size_t>(std::distance(begin(open), end(open)));
  }

 private:
  std::string tcp_ = on_loopback(free_port()), udp_ = on_loopback(free_port());
  tool_tests::Process emulator_;
};

/// The line of JSON that the client ends with, null where it finds fault.
json found(const Finished& client) {
  EXPECT_EQ(client.code, 0) << client.out << client.err;
  return json::parse(client.out, nullptr, false);
}

TEST(FenetClient, IsAnsweredAsTheManualSays) {
  const Finished client = EmulatedPlc().checked();
  EXPECT_EQ(client.code, 0) << client.out << client.err;
  EXPECT_THAT(client.out, testing::HasSubstr("ok one memory")) << "the last of all";
}

// For a minute: suites/xgt_fenet/peers/fenet_load.py load --seconds 60 --tcp 127.0.0.1:2004,
// beside fieldproof emulate 'xbc-h?protocol=xgt-fenet' --tcp 127.0.0.1:2004
TEST(FenetClient, LosesNoReplyAmongFourAtFullSpeed) {
  const json load = found(EmulatedPlc().loaded({"load", "--clients", "4", "--seconds", "2"}));
  EXPECT_GT(load.value("exchanges", 0), 100);
  for (const char* fault : {"lost", "crossed", "late"}) EXPECT_EQ(load.value(fault, -1), 0) << load;
}

TEST(FenetClient, IsOneOfFourServedAmongAThousandThatConnectAtOnce) {
  const EmulatedPlc plc;
  found(plc.loaded({"flood", "--connections", "4"}));  // whatever is opened once is open now
  const std::size_t before = plc.descriptors();
  const json flood = found(plc.loaded({"flood", "--connections", "1000"}));
  EXPECT_EQ(flood, json({{"served", 4}, {"reset", 996}, {"ended", 0}, {"silent", 0}}));
  EXPECT_EQ(plc.descriptors(), before);
}

TEST(FenetClient, IsServedBesideSlowOnesThatAreServedInTheEnd) {
  EXPECT_EQ(found(EmulatedPlc().loaded({"loris"})),
            json({{"exchanges", 2000}, {"slow_served", 3}}));
}

TEST(FenetClient, TakesThePlaceOfOneThatNeverEndsItsRequest) {
  const json starved = found(EmulatedPlc("&waiting_time=2").loaded({"starve", "--seconds", "60"}));
  EXPECT_TRUE(starved.value("served", false)) << starved;
  EXPECT_GT(starved.value("refused", 0), 0) << "all places were taken";
}

}  // namespace
}  // namespace fieldproof::fenet_peers
