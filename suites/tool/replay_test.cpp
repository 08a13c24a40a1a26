// The command line that a failure prints runs just that exchange again, out of any shell.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

constexpr const char* failing = "xgt_cnet/v/it_fails";

/// What follows "replay    " in a block of text, up to the end of its line.
std::string replay_in(const std::string& text) {
  const std::string mark = "  replay    ";
  const std::size_t at = text.find("replay    ");
  if (at == std::string::npos) return "no replay command in: " + text;
  const std::size_t start = at + mark.size() - 2;
  return text.substr(start, text.find('\n', start) - start);
}

/// Folders, files and devices whose names a shell would take apart.
class Replay : public testing::Test {
 protected:
  Replay() {
    const std::string odd = "it's a $HOME `x` \"y\" ; * & \\ <z> #1 한";
    vectors_ = folder_.write(odd + "/xgt_cnet/test.json",
                             nlohmann::ordered_json({small_vector("v/it_fails", wrong_word),
                                                     small_vector("v/it_fails_not")})
                                 .dump());
    vectors_ = std::filesystem::path(vectors_).parent_path().parent_path();
    // The bare name in the command is found as it is when it was installed.
    std::filesystem::create_directory(folder_ / "bin");
    std::filesystem::create_symlink(FIELDPROOF_TOOL, folder_ / "bin/fieldproof");
  }

  Finished run(std::vector<std::string> more) {
    std::vector<std::string> arguments{"run", "--vectors", vectors_, "--out", folder_ / "first"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments);
  }

  /// The commands of all places, in a shell: each runs the failing case alone, with the failure it
  /// had.
  void expect_replays(const Finished& first) {
    ASSERT_EQ(first.code, 1) << first.out << first.err;
    const nlohmann::json recorded = read_results(folder_ / "first/results.ndjson").of(failing);
    Junit junit;
    read_junit(folder_ / "first/junit.xml", junit);
    const std::string body =
        junit.cases["fieldproof.xgt_cnet.v it_fails"].child("failure").text().get();
    for (const std::string& command :
         {replay_in(first.out), replay_in(body), recorded.value("replay", "")}) {
      for (const char* shell : {"sh", "bash"}) {
        const Finished again =
            run_program({shell, "-c", command + " --out " + quoted(folder_ / "again")},
                        {{{"PATH", folder_ / "bin:" + std::getenv("PATH")}}, folder_.path()});
        ASSERT_EQ(again.code, 1) << command << '\n' << again.out << again.err;
        const Results results = read_results(folder_ / "again/results.ndjson");
        ASSERT_EQ(results.ids(), std::vector<std::string>{failing}) << command;
        EXPECT_EQ(results.cases.front().at("message"), recorded.at("message"));
        EXPECT_EQ(results.cases.front().value("received_bytes", ""),
                  recorded.value("received_bytes", ""));
      }
    }
  }

  TestFolder folder_;
  std::string vectors_;
};

TEST_F(Replay, of_the_emulator) { expect_replays(run({"--endpoint", "emulator:xbc-h?station=7"})); }

TEST_F(Replay, of_a_device_with_an_odd_command) {
  const std::string script =
      folder_.write("it's my \"device\".sh", "exec /usr/bin/python3 " FIELDPROOF_SOURCE_DIR
                                             "/suites/tool/testdata/device.py good \"$1\"\n");
  std::string inner = "'";
  for (const char c : script) inner += c == '\'' ? std::string("'\\''") : std::string(1, c);
  expect_replays(run({"--endpoint", "exec:sh " + inner + "' {tty}", "--profile", "xbc-h",
                      "--allow-write", "M100-M199", "--allow-write", "D0"}));
}

TEST_F(Replay, of_a_bench_file) {
  const std::string bench = folder_.write(
      "a bench's file.json",
      R"({"devices": {"my plc": {"endpoint": "emulator:xbc-h", "profile": "xbc-h", "station": 5, "line": "19200-8N1"}}})");
  expect_replays(run({"--bench", bench, "--dut", "my plc"}));
}

/// What fails by the options of the run alone fails again.
TEST_F(Replay, of_a_stricter_gate) {
  folder_.write("strict/xgt_cnet/test.json",
                nlohmann::ordered_json(
                    {small_vector("v/it_fails",
                                  {{"reading", "word"}, {"one", wrong_word}, {"zero", zero_word}}),
                     small_vector("v/it_fails_not")})
                    .dump());
  vectors_ = folder_ / "strict";
  expect_replays(run({"--endpoint", "emulator:xbc-h", "--strict", "--fail-on", "marginal",
                      "--floor", "0.5ms", "--seed", "3", "--power-cycle", "echo 'off and on'"}));
}

}  // namespace
}  // namespace fieldproof::tool_tests
