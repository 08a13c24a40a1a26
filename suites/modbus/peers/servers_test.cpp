// The suite against servers that nobody here has written. Where they deviate from the manual a
// waiver says which cases, with what message and why; a failure without waiver and a waiver without
// failure both turn the run red.
#include <gmock/gmock.h>

#include <memory>

#include "suites/broken/suite_runs.hpp"
#include "suites/modbus/peers/test_ports.hpp"

namespace fieldproof::modbus_peers {

using results::Verdict;

namespace {

struct Peer {
  std::string name;  // of its profile and waivers
  std::string command;
  std::string mode;
  std::size_t passes;            // at least
  bool running = false;          // it runs already, and is reached by tcp:
  std::string waived_as = name;  // whose waivers are its own, too

  std::string trial() const { return running ? name + "-running" : name; }
};

void PrintTo(const Peer& peer, std::ostream* out) { *out << peer.name; }

const std::string folder = FIELDPROOF_SOURCE_DIR "/suites/modbus/peers/";

std::vector<Peer> peers() {
  const std::string pymodbus =
      "exec /usr/bin/python3 " + tool_tests::quoted(folder + "pymodbus_server.py");
  const std::string libmodbus = "exec " + tool_tests::quoted(LIBMODBUS_SERVER);
  return {
      {"peer-libmodbus", libmodbus + " {tty}", "rtu", 200},
      {"peer-pymodbus-rtu", pymodbus + " rtu {tty}", "rtu", 200},
      {"peer-pymodbus-ascii", pymodbus + " ascii {tty}", "ascii", 200},
      {"peer-libmodbus-tcp", libmodbus + " tcp {port}", "tcp", 190},
      {"peer-pymodbus-tcp", pymodbus + " tcp {port}", "tcp", 160},
      {"peer-libmodbus-tcp", libmodbus + " tcp {port}", "tcp", 190, true},
      {"peer-pymodbus-tcp", pymodbus + " tcp {port}", "tcp", 160, true},
      {"peer-pymodbus-tcp-separate", pymodbus + " tcp {port} separate", "tcp", 150, false,
       "peer-pymodbus-tcp"},
  };
}

/// "DeviatesAsItsWaiversSayAndNowhereElse/peer_libmodbus"
std::string test_name(const Peer& peer) {
  std::string name = peer.trial();
  std::ranges::replace(name, '-', '_');
  return name;
}

/// The server in a process of its own, for as long as the tests run; where it is.
std::string start(const Peer& peer) {
  static std::vector<std::unique_ptr<tool_tests::Process>> started;
  const std::uint16_t port = free_port();
  std::string command = peer.command;
  command.replace(command.find("{port}"), 6, std::to_string(port));
  started.push_back(std::make_unique<tool_tests::Process>(
      std::vector<std::string>{"/bin/sh", "-c", command + " > /dev/null 2>&1"}));
  EXPECT_TRUE(is_served(port)) << command;
  return fmt::format("tcp:127.0.0.1:{}", port);
}

std::optional<broken::Trial> trial_of(const std::string& test) {
  for (const Peer& peer : peers())
    if (test_name(peer) == broken::parameter_of(test))
      return broken::Trial{peer.trial(),
                           fmt::format("{}?station=1&protocol=modbus-{}",
                                       peer.running ? start(peer) : peer.command, peer.mode),
                           peer.name,
                           {},
                           fmt::format("modbus_{}/*", peer.mode),
                           folder + peer.waived_as + ".waivers.json"};
  return std::nullopt;
}

broken::SuiteRuns& runs() {
  static auto* const environment = static_cast<broken::SuiteRuns*>(
      testing::AddGlobalTestEnvironment(new broken::SuiteRuns(trial_of)));
  return *environment;
}
[[maybe_unused]] const broken::SuiteRuns& registered_before_main = runs();

class ServerOfOthers : public testing::TestWithParam<Peer> {};

/// A device that runs before the bench comes and after it goes is given back as it was: what is
/// written in these cases lies beyond the memory that can be read before.
const std::vector<std::string> not_saved{
    "modbus_tcp/addressing/coils_across_the_end",
    "modbus_tcp/addressing/end_of_words_06/",
    "modbus_tcp/addressing/end_of_words_10/",
    "modbus_tcp/addressing/last_coil_forced",
    "modbus_tcp/addressing/longest_words_to_the_end/",
    "modbus_tcp/examples/write_",
    "modbus_tcp/exceptions/address_of_a_",
    "modbus_tcp/exceptions/address_of_coils/",
    "modbus_tcp/exceptions/address_of_registers/",
    "modbus_tcp/exceptions/byte_count_before_address_",
    "modbus_tcp/exceptions/last_address/",
    "modbus_tcp/exceptions/length_before_address/f05",
    "modbus_tcp/exceptions/length_before_address/f06",
    "modbus_tcp/exceptions/value_before_address",
    "modbus_tcp/limits/write_words_refused/c07d8",
};

/// libmodbus waits half a second for the rest of a frame and serves nobody meanwhile, as long as a
/// reply may take: now it is just in time, now late.
constexpr std::string_view at_the_limit = "modbus_tcp/segments/half_then_rst/";

/// However the server is reached, its verdicts are the same.
void expect_same(const broken::SuiteRun& started, const broken::SuiteRun& running) {
  ASSERT_EQ(started.results.size(), running.results.size());
  for (const auto& [id, result] : running.results) {
    const Verdict due = started.results.at(id).verdict;
    const bool unsaved = std::ranges::any_of(
        not_saved, [&id = id](const std::string& one) { return id.starts_with(one); });
    if (unsaved && result.verdict == Verdict::blocked) {
      EXPECT_THAT(result.message, testing::HasSubstr("it is beyond the area")) << id;
      continue;
    }
    if (id.starts_with(at_the_limit) && result.verdict != due)
      EXPECT_THAT((std::vector{result.verdict, due}),
                  testing::UnorderedElementsAre(Verdict::pass, Verdict::non_strict))
          << id << ": " << result.message;
    else
      EXPECT_EQ(result.verdict, due) << id << ": " << result.message;
  }
}

TEST_P(ServerOfOthers, DeviatesAsItsWaiversSayAndNowhereElse) {
  const Peer& peer = GetParam();
  static std::map<std::string, broken::SuiteRun> started;
  const broken::SuiteRun run = runs().take(peer.trial());
  EXPECT_EQ(run.tool.code, 0) << run.tool.out << run.tool.err;
  std::map<Verdict, std::size_t> count;
  for (const auto& [id, result] : run.results) ++count[result.verdict];
  EXPECT_GE(count[Verdict::pass], peer.passes);
  EXPECT_GE(count[Verdict::xfail], 1u) << "no peer follows the manual in all";
  runs().report(fmt::format("{:<26} {} pass, {} fail as waived, of {}, {:.1f} s", peer.trial(),
                            count[Verdict::pass], count[Verdict::xfail], run.results.size(),
                            run.seconds));
  if (!peer.running)
    started.emplace(peer.name, run);
  else if (started.contains(peer.name))  // not where a filter leaves it out
    expect_same(started.at(peer.name), run);
}

INSTANTIATE_TEST_SUITE_P(Peers, ServerOfOthers, testing::ValuesIn(peers()),
                         [](const auto& test) { return test_name(test.param); });

}  // namespace
}  // namespace fieldproof::modbus_peers
