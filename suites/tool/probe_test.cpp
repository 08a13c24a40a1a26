// `fieldproof probe` as a person at the bench uses it, on simulated and on real time.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "suites/tool/joined_ptys.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

Finished probe(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "probe");
  return run_tool(std::move(arguments));
}

/// Runs the command line that the probe prints, for one case alone.
Finished go_on(const std::string& printed, const std::string& filter, const TestFolder& folder) {
  const std::string mark = "go on with    fieldproof ";
  const std::size_t at = printed.find(mark);
  if (at == std::string::npos) return {-1, printed, "no command line"};
  const std::string line =
      printed.substr(at + mark.size(), printed.find('\n', at) - at - mark.size());
  return run_program({"sh", "-c",
                      quoted(FIELDPROOF_TOOL) + " " + line + " --filter " + quoted(filter) +
                          " --out " + quoted(folder / "out")});
}

TEST(Probe, FindsTheDeviceAndSaysHowToGoOn) {
  const TestFolder folder;
  const Finished found = probe({"emulator:xbc-h?line=38400-8E1&station=4&protocol=modbus-rtu"});
  EXPECT_EQ(found.code, 0) << found.out << found.err;
  EXPECT_THAT(
      found.out,
      HasSubstr("8 speeds x 6 frames x 32 stations x xgt-cnet, modbus-rtu, modbus-ascii, ls-bus"));
  EXPECT_THAT(found.out, HasSubstr("found         38400-8E1, modbus-rtu, station 4, answers in "));
  EXPECT_THAT(found.err, ContainsRegex("\\[2/[0-9]+\\] 9600-8N1 xgt-cnet station 1: silence"));
  const Finished run = go_on(found.out, "modbus_rtu/exceptions*", folder);
  EXPECT_EQ(run.code, 0) << run.out << run.err;
}

TEST(Probe, FindsADeviceOnAPort) {
  const TestFolder folder;
  const JoinedPtys line("xbc-h?station=3&protocol=modbus-rtu");
  const Finished found = probe({"serial:" + line.bench(), "--station", "1-3", "--wait", "200"});
  EXPECT_EQ(found.code, 0) << found.out << found.err;
  EXPECT_THAT(found.out, HasSubstr("no speed and no frame of its own")) << "a pty has none";
  EXPECT_THAT(found.out, HasSubstr("found         modbus-rtu, station 3, answers in "));
  const Finished run = go_on(found.out, "modbus_rtu/*", folder);
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_THAT(run.out, HasSubstr("PASS"));
}

TEST(Probe, NamesWhatIsWrong) {
  const Finished silent = probe(
      {"emulator:xbc-h?station=9", "--station", "1,2", "--speed", "9600,19200", "--frame", "8N1"});
  EXPECT_EQ(silent.code, 1);
  EXPECT_THAT(silent.out, HasSubstr("2 speeds x 1 frame x 2 stations"));
  EXPECT_THAT(silent.out, HasSubstr("silence       nothing on the line: 17 trials"));

  const Finished echo = probe({"exec:sh -c 'exec cat <{tty} >{tty}'", "--station", "1",
                               "--protocol", "xgt-cnet", "--wait", "50"});
  EXPECT_EQ(echo.code, 1);
  EXPECT_THAT(echo.out, HasSubstr("echo          our own question comes back, and nothing else"))
      << echo.err;

  const Finished two =
      probe({"emulator:xbc-h?neighbours=[{\"station\":1,\"rs485\":true,\"delay_ms\":50}]"});
  EXPECT_EQ(two.code, 1);
  EXPECT_THAT(two.out, HasSubstr("two devices   9600-8N1, two replies come to one question"));
}

TEST(Probe, WrongUsage) {
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{},
                                                {"bogus:x"},
                                                {"emulator:", "--station", "300"},
                                                {"emulator:", "--station", "5-2"},
                                                {"emulator:", "--speed", "fast"},
                                                {"emulator:", "--frame", "9X1"},
                                                {"emulator:", "--protocol", "nonsense"},
                                                {"emulator:", "--protocol", "user-frames"},
                                                {"tcp:127.0.0.1:1", "--speed", "9600"}}) {
    const Finished finished = probe(wrong);
    EXPECT_EQ(finished.code, 2) << (wrong.empty() ? "" : wrong.back()) << finished.out;
    EXPECT_THAT(finished.out + finished.err, Not(HasSubstr("probing")));
  }
}

TEST(Probe, TroubleOfThePort) {
  const Finished absent = probe({"serial:/nonexistent"});
  EXPECT_EQ(absent.code, 3);
  EXPECT_THAT(absent.err, HasSubstr("there is no such port"));
}

TEST(Probe, AnInterruptEndsIt) {
  const JoinedPtys line;
  Process running(tool_arguments({"probe", "serial:" + line.bench()}));
  ASSERT_TRUE(running.wait_for("[2/"));
  running.signal(SIGINT);
  const Finished finished = running.wait();
  EXPECT_EQ(finished.code, 130) << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("interrupted"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
