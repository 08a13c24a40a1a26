// `run --matrix`: the cases at each line setting, on the emulator without a question, elsewhere by
// hook or by hand.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

class Matrix : public testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& endpoint, const std::string& matrix,
                                     const std::vector<std::string>& more = {}) {
    std::vector<std::string> result{
        "run",   "--endpoint", endpoint,   "--vectors", write_vectors(folder_, vectors_),
        "--out", out_,         "--matrix", matrix};
    result.insert(result.end(), more.begin(), more.end());
    return tool_arguments(result);
  }
  Results results() { return read_results(out_ + "/results.ndjson"); }
  std::vector<std::string> lines() {
    std::vector<std::string> result;
    for (const nlohmann::json& one : results().cases)
      result.push_back(one.value("line", "none") + ' ' + one["verdict"].get<std::string>());
    return result;
  }
  /// A pty pair, with an emulated device at one end; the other is the port of the bench.
  std::string serial_port() {
    const std::string bench = folder_ / "bench", plc = folder_ / "plc";
    socat_.emplace(std::vector<std::string>{"socat", "-d", "-d", "pty,raw,echo=0,link=" + bench,
                                            "pty,raw,echo=0,link=" + plc});
    EXPECT_TRUE(socat_->wait_for("starting data transfer loop"));
    device_.emplace(tool_arguments({"emulate", "xbc-h", "--pty", plc}));
    return "serial:" + bench;
  }

  TestFolder folder_;
  std::string out_ = folder_ / "out";
  std::vector<nlohmann::ordered_json> vectors_ = {small_vector("v/a"), small_vector("v/b")};
  std::optional<Process> socat_, device_;
};

TEST(MatrixOfNetworks, HasNoStep) {
  const TestFolder folder;
  const auto run = [&](const std::string& filter) {
    return run_tool(
        {"run", "--matrix", "9600,38400 x 8N1", "--filter", filter, "--out", folder / "out"});
  };
  const Finished none = run("modbus_tcp/examples/*:user_frames_net/*");
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("each selected case runs on a network; select others"));
  const Finished both = run("modbus_rtu/examples/read*:modbus_tcp/examples/*");
  EXPECT_EQ(both.code, 0) << both.out << both.err;
  EXPECT_THAT(both.out, HasSubstr("that run on a network"));
  for (const nlohmann::json& one : read_results(folder / "out/results.ndjson").cases)
    EXPECT_NE(one.at("protocol"), "modbus-tcp") << one.at("id");
}

TEST_F(Matrix, TheEmulatorIsSetAtEachStep) {
  nlohmann::ordered_json own = small_vector("v/own_line");
  own["given"]["config"]["line"] = "9600-8E1";
  vectors_ = {small_vector("v/a"), own};
  const Finished finished =
      run_program(arguments("emulator:xbc-h", "9600,38400 x 8N1,8E1", {"--repeat", "2"}));
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(lines(), testing::ElementsAre(
                           "9600-8N1 PASS", "9600-8N1 SKIP", "9600-8N1 PASS", "9600-8N1 SKIP",  //
                           "9600-8E1 PASS", "9600-8E1 PASS", "9600-8E1 PASS", "9600-8E1 PASS",  //
                           "38400-8N1 PASS", "38400-8N1 SKIP", "38400-8N1 PASS", "38400-8N1 SKIP",
                           "38400-8E1 PASS", "38400-8E1 SKIP", "38400-8E1 PASS", "38400-8E1 SKIP"));
  EXPECT_THAT(finished.out, HasSubstr("line 38400-8E1, step 4 of 4"));
  expect_reports(out_);
  Junit junit;
  read_junit(out_ + "/junit.xml", junit);
  EXPECT_EQ(junit.cases.size(), 16u) << "no two of one name";
  EXPECT_TRUE(junit.cases["fieldproof.xgt_cnet.v a [38400-8N1] #2"]);
  EXPECT_THAT(read_text(out_ + "/report.html"), HasSubstr("xgt_cnet/v/a [38400-8N1]"));
}

/// The bench really changes the line: what a character takes is in the times of the exchange.
TEST_F(Matrix, CharacterTimesFollowTheStep) {
  ASSERT_EQ(run_program(arguments("emulator:xbc-h", "1200,115200 x 8E2")).code, 0);
  const auto duration = [](const nlohmann::json& one) {
    return one["exchange"][0]["end_ms"].get<double>() -
           one["exchange"][0]["start_ms"].get<double>();
  };
  const Results all = results();
  EXPECT_NEAR(duration(all.cases[0]), 19 * 12 / 1.2, 1e-3);
  EXPECT_NEAR(duration(all.cases[2]), 19 * 12 / 115.2, 1e-3);
}

TEST_F(Matrix, APtyProvesNothingAboutTheLine) {
  vectors_.push_back(small_vector("v/wrong", wrong_word));
  const Finished finished = run_program(arguments("pty:xbc-h", "38400 x 8N1"));
  EXPECT_EQ(finished.code, 1) << "a wrong answer stays wrong";
  EXPECT_THAT(lines(), testing::ElementsAre("38400-8N1 INCONCLUSIVE", "38400-8N1 INCONCLUSIVE",
                                            "38400-8N1 FAIL"));
  EXPECT_THAT(results().cases[0]["message"], HasSubstr("no speed and no character format"));
}

TEST_F(Matrix, AHookSetsTheDevice) {
  const std::string log = folder_ / "hook.log";
  const std::string hook =
      "test \"$FIELDPROOF_SPEED\" != 19200 && echo \"$FIELDPROOF_SPEED-$FIELDPROOF_FRAME\" >>" +
      log + " && echo";
  const Finished finished =
      run_program(arguments(serial_port(), "9600,19200,38400 x 8N1", {"--reconfigure", hook}));
  EXPECT_EQ(finished.code, 4) << finished.out << finished.err << "a pty pair carries no line";
  EXPECT_EQ(read_text(log), "9600-8N1\n38400-8N1\n");
  EXPECT_THAT(finished.err, HasSubstr("9600 8N1\n")) << "the arguments";
  EXPECT_THAT(lines(), testing::ElementsAre("9600-8N1 INCONCLUSIVE", "9600-8N1 INCONCLUSIVE",
                                            "19200-8N1 BLOCKED", "19200-8N1 BLOCKED",
                                            "38400-8N1 INCONCLUSIVE", "38400-8N1 INCONCLUSIVE"));
  EXPECT_THAT(results().cases[2]["message"], HasSubstr("not reachable: the command"));
}

/// `script` gives the tool a terminal; the engineer's keys come from a file.
TEST_F(Matrix, TheEngineerIsAsked) {
  std::string command = "exec";
  for (const std::string& one : arguments(serial_port(), "9600,19200,38400,57600 x 8N1"))
    command += ' ' + quoted(one);
  const std::string keys = folder_.write("keys", "\ns\nq\n");
  const Finished finished =
      run_program({"/bin/sh", "-c", "script --quiet --return --command \"$1\" /dev/null <\"$2\"",
                   "sh", command, keys});
  EXPECT_EQ(finished.code, 4) << finished.out;
  EXPECT_THAT(finished.out, HasSubstr("step 2 of 4: set the device to 19200 bit/s, 8N1"));
  EXPECT_THAT(finished.out, testing::Not(HasSubstr("step 4 of 4: set the device")));
  const Results all = results();
  ASSERT_EQ(all.cases.size(), 8u);
  EXPECT_EQ(all.cases[0]["verdict"], "INCONCLUSIVE");
  EXPECT_EQ(all.cases[2]["message"], "skipped by the engineer: 19200-8N1");
  EXPECT_EQ(all.cases[6]["message"], "not run: the engineer ended the matrix before 38400-8N1");
  expect_reports(out_);
}

/// Interrupted while it waits for the hook.
TEST_F(Matrix, AnInterruptWritesTheReports) {
  Process process(arguments(serial_port(), "9600 x 8N1",
                            {"--reconfigure", "echo hook runs; exec sleep 3600; :"}));
  ASSERT_TRUE(process.wait_for("hook runs"));
  process.signal(SIGTERM);
  const Finished finished = process.wait();
  EXPECT_EQ(finished.code, 130) << finished.err;
  expect_reports(out_);
}

TEST_F(Matrix, WrongOptionsAreRefused) {
  const auto refused = [&](const std::string& endpoint, const std::string& matrix,
                           const std::vector<std::string>& more = {}) {
    const Finished finished = run_program(arguments(endpoint, matrix, more));
    EXPECT_EQ(finished.code, 2) << finished.out;
    return finished.err;
  };
  EXPECT_THAT(refused("emulator:xbc-h", "300 x 8N1"),
              HasSubstr("cannot read --matrix '300 x 8N1'"));
  EXPECT_THAT(refused("serial:/dev/null", "9600 x 8N1"), HasSubstr("give --reconfigure COMMAND"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
