// The suite against servers that nobody here has written. Where they deviate from the manual a
// waiver says which cases, with what message and why; a failure without waiver and a waiver without
// failure both turn the run red.
#include <gmock/gmock.h>

#include "suites/broken/suite_runs.hpp"

namespace fieldproof::modbus_peers {

using results::Verdict;

namespace {

struct Peer {
  std::string name;  // of its profile and waivers
  std::string command;
  std::string mode;
  std::size_t passes;  // at least
};

void PrintTo(const Peer& peer, std::ostream* out) { *out << peer.name; }

const std::string folder = FIELDPROOF_SOURCE_DIR "/suites/modbus/peers/";

std::vector<Peer> peers() {
  const std::string pymodbus =
      "/usr/bin/python3 " + tool_tests::quoted(folder + "pymodbus_server.py");
  return {
      {"peer-libmodbus", tool_tests::quoted(LIBMODBUS_SERVER) + " {tty}", "rtu", 200},
      {"peer-pymodbus-rtu", pymodbus + " rtu {tty}", "rtu", 200},
      {"peer-pymodbus-ascii", pymodbus + " ascii {tty}", "ascii", 200},
  };
}

/// "DeviatesAsItsWaiversSayAndNowhereElse/peer_libmodbus"
std::string test_name(const Peer& peer) {
  std::string name = peer.name;
  std::ranges::replace(name, '-', '_');
  return name;
}

std::optional<broken::Trial> trial_of(const std::string& test) {
  for (const Peer& peer : peers())
    if (test_name(peer) == broken::parameter_of(test))
      return broken::Trial{peer.name,
                           fmt::format("{}?station=1&protocol=modbus-{}", peer.command, peer.mode),
                           peer.name,
                           {},
                           fmt::format("modbus_{}/*", peer.mode),
                           folder + peer.name + ".waivers.json"};
  return std::nullopt;
}

broken::SuiteRuns& runs() {
  static auto* const environment = static_cast<broken::SuiteRuns*>(
      testing::AddGlobalTestEnvironment(new broken::SuiteRuns(trial_of)));
  return *environment;
}
[[maybe_unused]] const broken::SuiteRuns& registered_before_main = runs();

class ServerOfOthers : public testing::TestWithParam<Peer> {};

TEST_P(ServerOfOthers, DeviatesAsItsWaiversSayAndNowhereElse) {
  const Peer& peer = GetParam();
  const broken::SuiteRun run = runs().take(peer.name);
  EXPECT_EQ(run.tool.code, 0) << run.tool.out << run.tool.err;
  std::map<Verdict, std::size_t> count;
  for (const auto& [id, result] : run.results) ++count[result.verdict];
  EXPECT_GE(count[Verdict::pass], peer.passes);
  EXPECT_GE(count[Verdict::xfail], 1u) << "no peer follows the manual in all";
  runs().report(fmt::format("{:<20} {} pass, {} fail as waived, of {}, {:.1f} s", peer.name,
                            count[Verdict::pass], count[Verdict::xfail], run.results.size(),
                            run.seconds));
}

INSTANTIATE_TEST_SUITE_P(Peers, ServerOfOthers, testing::ValuesIn(peers()),
                         [](const auto& test) { return test_name(test.param); });

}  // namespace
}  // namespace fieldproof::modbus_peers
