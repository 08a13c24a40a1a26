// `run --duration`: hours of repetitions in flat memory and a small file, with what they came to at
// the end.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

class Soak : public testing::Test {
 protected:
  std::vector<std::string> arguments(const std::vector<nlohmann::ordered_json>& vectors,
                                     const std::string& duration,
                                     const std::string& endpoint = "emulator:xbc-h") {
    return tool_arguments({"run", "--endpoint", endpoint, "--vectors",
                           write_vectors(folder_, vectors), "--out", out_, "--duration", duration});
  }
  Results results() { return read_results(out_ + "/results.ndjson"); }

  TestFolder folder_;
  std::string out_ = folder_ / "out";
};

TEST_F(Soak, RepeatsUntilTheTimeIsOver) {
  const Finished finished = run_program(arguments(many_vectors(2), "2s"));
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  const Results all = results();
  EXPECT_EQ(all.cases.size(), 2u) << "the first repetition of each";
  ASSERT_FALSE(all.soak.is_null());
  EXPECT_GT(all.soak["rounds"], 1);
  EXPECT_EQ(all.soak["cases"]["xgt_cnet/many/n1000"]["counts"].size(), 1u);
  EXPECT_GE(all.soak["judged"].get<int>(), 2 * all.soak["rounds"].get<int>() - 1);
  EXPECT_GE(all.samples.size(), 1u);
  EXPECT_THAT(finished.out, HasSubstr("error rate 0 %"));
  EXPECT_THAT(finished.out, HasSubstr("drift      first tenth median"));
  EXPECT_THAT(read_text(out_ + "/report.html"), HasSubstr("judged repetitions"));
  expect_reports(out_);
  Junit junit;
  read_junit(out_ + "/junit.xml", junit);
  EXPECT_TRUE(junit.document.select_node("//property[@name='soak']"));
}

/// Every repetition fails: few are written, all are counted, and the gate is red.
TEST_F(Soak, FailuresAreWrittenAsFarAsThereIsRoom) {
  const Finished finished =
      run_program(arguments({small_vector("v/good"), small_vector("v/wrong", wrong_word)}, "2s"));
  EXPECT_EQ(finished.code, 1);
  const Results all = results();
  const std::uint64_t failed = all.soak["failed"], unwritten = all.soak["unwritten"];
  const std::uint64_t written = all.counts().at("FAIL");
  EXPECT_EQ(failed, written + unwritten);
  EXPECT_LE(written, 21u);
  EXPECT_NEAR(all.soak["error_rate"].get<double>(), 0.5, 0.02);
  expect_reports(out_);
}

/// Peak memory of a soak does not follow its repetitions: one of a single round against one of
/// three seconds. The room is for what the allocator and the reports keep.
TEST_F(Soak, MemoryAndFileStayFlat) {
  const Finished brief = run_program(arguments(many_vectors(1), "200ms"));
  const Finished longer = run_program(arguments(many_vectors(1), "3s"));
  ASSERT_EQ(brief.code, 0) << brief.err;
  ASSERT_EQ(longer.code, 0) << longer.err;
  EXPECT_GT(results().soak["rounds"], 100);
#ifdef FIELDPROOF_SANITIZED               // the tool, not this test
  constexpr int quarantine_kib = 20'000;  // of freed memory, which a brief run does not fill
#else
  constexpr int quarantine_kib = 0;
#endif
  EXPECT_LT(longer.peak_kib, brief.peak_kib + 4096 + quarantine_kib)
      << results().soak["rounds"] << " rounds";
  EXPECT_LT(std::filesystem::file_size(out_ + "/results.ndjson"), 50'000u);
}

TEST_F(Soak, AnInterruptWritesTheReports) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::vector<std::string> command =
        arguments({small_vector("v/wrong", wrong_word)}, "8h", "pty:xbc-h");
    Process process(command);
    ASSERT_TRUE(process.wait_for("v/wrong")) << "it has begun";
    process.signal(signal);
    const Finished finished = process.wait();
    EXPECT_EQ(finished.code, 130) << finished.out << finished.err;
    const Results all = results();
    ASSERT_FALSE(all.soak.is_null());
    EXPECT_EQ(all.soak["planned_s"], 28'800);
    EXPECT_GE(all.soak["failed"], 1);
    EXPECT_TRUE(all.end["interrupted"]);
    expect_reports(out_);
  }
}

/// What it had come to is in its samples.
TEST_F(Soak, AKilledOneIsReportedFromItsSamples) {
  std::filesystem::create_directories(out_);
  const FileWatch results_watch(out_ + "/results.ndjson");
  Process process(arguments(many_vectors(1), "8s"));
  ASSERT_TRUE(results_watch.wait_until(
      [](const std::string& text) { return text.find("{\"sample\":") != text.npos; }));
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait().code, 128 + SIGKILL);
  EXPECT_EQ(run_tool({"report", out_ + "/results.ndjson", "--junit", out_ + "/junit.xml", "--json",
                      out_ + "/results.json", "--html", out_ + "/report.html"})
                .code,
            0);
  expect_reports(out_);
  EXPECT_THAT(read_text(out_ + "/junit.xml"),
              testing::ContainsRegex("the run was killed: 1 results were written before; [1-9] s "
                                     "of soak: [0-9]+ judged repetitions, 0 red"));
}

TEST_F(Soak, WhereNothingRunsItEnds) {
  nlohmann::ordered_json other = small_vector("v/other_model");
  other["models"] = {"xec-h"};
  const Finished finished = run_program(arguments({other}, "8h"));
  EXPECT_EQ(finished.code, 4) << finished.out;
}

/// A device that goes away ends the soak: there is nothing to wait for.
TEST_F(Soak, ADeviceThatVanishesIsTrouble) {
  const std::string device = std::string("exec:python3 ") + FIELDPROOF_SOURCE_DIR +
                             "/suites/tool/testdata/device.py die {tty} 100";
  const Finished finished = run_program(arguments(many_vectors(1), "8h", device));
  EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
  ASSERT_FALSE(results().soak.is_null());
  EXPECT_GT(results().soak["cases"]["xgt_cnet/many/n1000"]["counts"]["PASS"], 10);
  expect_reports(out_);
}

TEST_F(Soak, WrongOptionsAreRefused) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--repeat", "2"}, {"--matrix", "9600 x 8N1"}}) {
    std::vector<std::string> command = arguments(many_vectors(1), "8h");
    command.insert(command.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(command).code, 2);
  }
  EXPECT_THAT(run_program(arguments(many_vectors(1), "8 hours")).err,
              HasSubstr("--duration: '8 hours' is no duration"));
  EXPECT_EQ(run_program(arguments(many_vectors(1), "0s")).code, 2);
}

}  // namespace
}  // namespace fieldproof::tool_tests
