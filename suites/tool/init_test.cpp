// `fieldproof init`: from nothing to a bench file, a first run and a job for CI.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "harness/system/sockets/test_sockets.hpp"
#include "reports/text/fold.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

std::string read(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// `init` in the folder, where it writes its files.
Finished init(const TestFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"init", "--yes"});
  return run_tool(arguments, {{}, folder.path()});
}

const std::string inverter =
    "exec:python3 -B " FIELDPROOF_SOURCE_DIR "/suites/example/inverter.py {tty} 3 address_first";

TEST(Init, FindsTheExampleDeviceAndRunsItsCases) {
  const TestFolder folder;
  const Finished finished = init(folder, {"--endpoint", inverter, "--protocol", "ls-bus", "--name",
                                          "fan", "--firmware", "1.2", "--ci", "gitlab"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const nlohmann::json bench = nlohmann::json::parse(read(folder / "bench.json"));
  const nlohmann::json& device = bench["devices"]["fan"];
  EXPECT_THAT(device["endpoint"], HasSubstr("station=3"));
  EXPECT_THAT(device["endpoint"], HasSubstr("protocol=ls-bus"));
  EXPECT_EQ(device["profile"], "inverter");
  EXPECT_EQ(device["identity"]["firmware"], "1.2");
  Results results = read_results(folder / "fieldproof-out/results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 140u);
  const std::string job = read(folder / ".gitlab-ci.yml");
  EXPECT_THAT(job, HasSubstr("--bench bench.json --dut fan --role server --min-judged "));
  EXPECT_THAT(job, HasSubstr("junit: fieldproof-out/junit.xml"));
}

TEST(Init, AddsToABenchFileAndKeepsWhatIsThere) {
  const TestFolder folder;
  EXPECT_EQ(init(folder, {"--endpoint", "emulator:xbc-h", "--no-run", "--name", "one"}).code, 0);
  const Finished second =
      init(folder, {"--endpoint", "emulator:xec-h", "--no-run", "--name", "two", "--ci", "github"});
  EXPECT_EQ(second.code, 0) << second.err;
  const nlohmann::json bench = nlohmann::json::parse(read(folder / "bench.json"));
  EXPECT_EQ(bench["devices"]["one"]["profile"], "xbc-h");
  EXPECT_EQ(bench["devices"]["two"]["profile"], "xec-h");
  EXPECT_THAT(read(folder / ".github/workflows/conformance.yml"),
              HasSubstr("fieldproof/run.sh run --bench bench.json --dut two"));

  const Finished again =
      init(folder, {"--endpoint", "emulator:xbc-h", "--no-run", "--name", "two"});
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.err, HasSubstr("bench.json has a device 'two' already"));
  const Finished third = init(
      folder, {"--endpoint", "emulator:xbc-h", "--no-run", "--name", "three", "--ci", "github"});
  EXPECT_THAT(third.out, HasSubstr("is there already; this would be the job:"));
  EXPECT_THAT(read(folder / ".github/workflows/conformance.yml"), Not(HasSubstr("three")));
}

TEST(Init, AProgramOnANetworkIsAskedByEveryProtocol) {
  const TestFolder folder;
  const Finished finished =
      init(folder, {"--endpoint",
                    "exec:" FIELDPROOF_TOOL " emulate 'xbc-h?protocol=modbus-tcp' --tcp {port}",
                    "--no-run"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const nlohmann::json bench = nlohmann::json::parse(read(folder / "bench.json"));
  EXPECT_THAT(bench["devices"]["dut"]["endpoint"], HasSubstr("protocol=modbus-tcp"));
}

/// A server on a port of its own is found as one: no protocol is named.
TEST(Init, AServerAtAnyPortIsFoundAndItsCasesAreRun) {
  const TestFolder folder;
  const std::string address =
      "127.0.0.1:" + std::to_string(os::test::port_of(os::test::bound(SOCK_STREAM)));
  Process plc(tool_arguments({"emulate", "xbc-h?protocol=modbus-tcp", "--tcp", address}));
  ASSERT_TRUE(plc.wait_for("tcp " + address));
  const Finished finished =
      init(folder, {"--endpoint", "tcp:" + address, "--profile", "xbc-h", "--allow-write", "all"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const nlohmann::json bench = nlohmann::json::parse(read(folder / "bench.json"));
  EXPECT_THAT(bench["devices"]["dut"]["endpoint"],
              AllOf(HasSubstr("tcp:" + address), HasSubstr("protocol=modbus-tcp")));
  Results results = read_results(folder / "fieldproof-out/results.ndjson");
  EXPECT_GT(results.counts()["PASS"], 100u);
}

/// And a line behind a port, too.
TEST(Init, ALineBehindAPortIsSearchedWhereNoServerIs) {
  const TestFolder folder;
  const std::string address =
      "127.0.0.1:" + std::to_string(os::test::port_of(os::test::bound(SOCK_STREAM)));
  Process plc(tool_arguments({"emulate", "xbc-h", "--tcp", address}));
  ASSERT_TRUE(plc.wait_for("tcp " + address));
  const Finished finished = init(folder, {"--endpoint", "tcp:" + address, "--no-run"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const nlohmann::json bench = nlohmann::json::parse(read(folder / "bench.json"));
  EXPECT_THAT(bench["devices"]["dut"]["endpoint"], HasSubstr("protocol=xgt-cnet"));
}

/// `script` makes the terminal; what is typed waits there until it is read.
TEST(Init, ItsQuestionsAreAnsweredOnATerminal) {
  const TestFolder folder;
  folder.write("typed", inverter + "?protocol=ls-bus\n\nfan\n\n1.2\ngitlab\n");
  const std::string call = "stty cols 80 -echo && exec " + quoted(FIELDPROOF_TOOL) + " init";
  const Finished finished = run_program(
      {"bash", "-c", "script --quiet --return --command \"$1\" /dev/null <typed", "bash", call},
      {{}, folder.path()});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  for (const char* question :
       {"Where is the device? (--endpoint): ", "Which model is it? (--profile) [inverter]: ",
        "Its name on this bench? (--name) [dut]: ", "Serial number, if any? (--serial): ",
        "Firmware version, if known? (--firmware): ", "(--ci) [none]: "})
    EXPECT_THAT(finished.out, HasSubstr(question));
  // But for what was typed and for the questions, between which no Enter stands.
  for (std::string line : text_lines(finished.out)) {
    line.erase(std::min(line.find('\r'), line.size()));
    if (line.find("(--") == std::string::npos && !line.starts_with("exec:")) {
      EXPECT_LE(text::columns_of(line), 80u) << line;
    }
  }
  const nlohmann::json bench = nlohmann::json::parse(read(folder / "bench.json"));
  EXPECT_EQ(bench["devices"]["fan"]["profile"], "inverter");
  EXPECT_EQ(bench["devices"]["fan"]["identity"]["firmware"], "1.2");
  EXPECT_FALSE(bench["devices"]["fan"]["identity"].contains("serial"));
  EXPECT_GT(read_results(folder / "fieldproof-out/results.ndjson").counts()["PASS"], 140u);
  EXPECT_THAT(read(folder / ".gitlab-ci.yml"), HasSubstr("--dut fan"));
}

TEST(Init, WhatNoOneAnswersIsNamed) {
  const TestFolder folder;
  const Finished nothing = init(folder, {});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err, HasSubstr("give --endpoint"));
  const Finished unknown = init(folder, {"--endpoint", "emulator:xbc-h", "--ci", "jenkins"});
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("write github, gitlab or none"));
  EXPECT_FALSE(std::filesystem::exists(folder / "bench.json"));
}

TEST(Init, WhereNothingAnswersNothingIsWritten) {
  const TestFolder folder;
  const Finished finished =
      init(folder, {"--endpoint", "exec:sleep 100 # {tty}?station=1", "--protocol", "ls-bus"});
  EXPECT_EQ(finished.code, 3) << finished.out;
  EXPECT_THAT(finished.err, HasSubstr("nothing was written"));
  EXPECT_FALSE(std::filesystem::exists(folder / "bench.json"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
