// The suite against a server that was written from the manual alone, by a second hand in another
// language: what the manual does not print it has decided in its own way, and nothing may fail.
#include <gmock/gmock.h>

#include <memory>

#include "suites/broken/suite_runs.hpp"
#include "suites/modbus/peers/test_ports.hpp"

namespace fieldproof::fenet_peers {

using results::Verdict;

namespace {

struct Peer {
  std::string profile;
  std::string part;  // of the suite; several at once take less time
  std::string filter;
  std::size_t passes;        // at least
  std::string options = "";  // of the server's command
  bool running = false;      // it runs already, and is reached by tcp:

  std::string trial() const { return profile + '-' + part; }
};

void PrintTo(const Peer& peer, std::ostream* out) { *out << peer.trial(); }

const std::vector<Peer> peers{
    {"peer-asyncio-fenet", "connections", "xgt_fenet/connections/*", 25},
    {"peer-asyncio-fenet", "frames", "xgt_fenet/segments/*:xgt_fenet/udp/*:xgt_fenet/length/*", 80},
    {"peer-asyncio-fenet", "rest",
     "xgt_fenet/*:-xgt_fenet/connections/*:-xgt_fenet/segments/*:-xgt_fenet/udp/*"
     ":-xgt_fenet/length/*",
     180},
    {"peer-asyncio-fenet", "running", "xgt_fenet/read/*:xgt_fenet/write/*:xgt_fenet/udp/*", 80, "",
     true},
    {"peer-asyncio-fenet-stop", "all", "xgt_fenet/header/*:xgt_fenet/read/*", 60, " --mode stop"},
};

/// "HasItsOwnDecisionsAndNoFault/peer_asyncio_fenet_rest"
std::string test_name(const Peer& peer) {
  std::string name = peer.trial();
  std::ranges::replace(name, '-', '_');
  return name;
}

std::string command(const Peer& peer, const std::string& tcp, const std::string& udp) {
  return fmt::format(
      "exec /usr/bin/python3 {} {} --udp-port {} --wait 2{}",
      tool_tests::quoted(FIELDPROOF_SOURCE_DIR "/suites/xgt_fenet/peers/fenet_server.py"), tcp, udp,
      peer.options);
}

/// The server in a process of its own, for as long as the tests run; where it is.
std::string start(const Peer& peer) {
  static std::vector<std::unique_ptr<tool_tests::Process>> started;
  const std::uint16_t tcp = modbus_peers::free_port(), udp = modbus_peers::free_port();
  started.push_back(std::make_unique<tool_tests::Process>(std::vector<std::string>{
      "/bin/sh", "-c", command(peer, std::to_string(tcp), std::to_string(udp))}));
  EXPECT_TRUE(modbus_peers::is_served(tcp)) << peer.trial();
  return fmt::format("tcp:127.0.0.1:{}?udp={}&", tcp, udp);
}

std::optional<broken::Trial> trial_of(const std::string& test) {
  for (const Peer& peer : peers)
    if (test_name(peer) == broken::parameter_of(test))
      return broken::Trial{
          peer.trial(),
          (peer.running ? start(peer) : command(peer, "{port}", "{udp_port}") + '?') +
              "protocol=xgt-fenet",
          peer.profile,
          {},
          peer.filter};
  return std::nullopt;
}

broken::SuiteRuns& runs() {
  static auto* const environment = static_cast<broken::SuiteRuns*>(
      testing::AddGlobalTestEnvironment(new broken::SuiteRuns(trial_of)));
  return *environment;
}
[[maybe_unused]] const broken::SuiteRuns& registered_before_main = runs();

class FenetServerOfAnotherHand : public testing::TestWithParam<Peer> {};

TEST_P(FenetServerOfAnotherHand, HasItsOwnDecisionsAndNoFault) {
  const Peer& peer = GetParam();
  const broken::SuiteRun run = runs().take(peer.trial());
  broken::expect_healthy(run, peer.passes);
  std::map<Verdict, std::size_t> count;
  for (const auto& [id, result] : run.results) {
    ++count[result.verdict];
    if (result.verdict == Verdict::non_strict) {
      EXPECT_EQ(result.basis, "decision") << id << ": " << result.message;
    }
  }
  EXPECT_GE(count[Verdict::non_strict], 1u) << "nobody has decided as we have in all";
  runs().report(fmt::format("{:<32} {} pass, {} decided otherwise, of {}, {:.1f} s", peer.trial(),
                            count[Verdict::pass], count[Verdict::non_strict], run.results.size(),
                            run.seconds));
}

/// What it answers in its own way is learnt, and kept to.
TEST(FenetServer, ShowsNothingToAnExploration) {
  const Peer& peer = peers.front();
  const tool_tests::TestFolder out;
  const tool_tests::Finished finished = tool_tests::run_tool(
      {"explore", "--seed", "1", "--requests", "150", "--profile", peer.profile, "--endpoint",
       "exec:" + command(peer, "{port}", "{udp_port}") + "?protocol=xgt-fenet", "--out",
       out.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
}

INSTANTIATE_TEST_SUITE_P(Peers, FenetServerOfAnotherHand, testing::ValuesIn(peers),
                         [](const auto& test) { return test_name(test.param); });

}  // namespace
}  // namespace fieldproof::fenet_peers
