// The suite against devices that it starts, as a user would: the built tool, the device in a
// process of its own, a pty between. Most of the time of a run is waiting, so several run at once.
// For tests.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "reports/results/ndjson.hpp"
#include "suites/tool/tool.hpp"

namespace fieldproof::broken {

/// One run of the tool.
struct Trial {
  std::string name;  // unique
  // Command that starts it, with {tty} and options: "PROGRAM {tty}?station=1"; or the endpoint of
  // one that runs already: "tcp:127.0.0.1:1502?protocol=modbus-tcp".
  std::string device;
  std::string profile = "xbc-h";
  std::string vectors{};  // a file or a folder; empty: the whole suite, which starts first
  std::string filter{};   // empty: all
  std::string waivers{};  // a file; empty: none
};

struct SuiteRun {
  tool_tests::Finished tool;
  std::map<std::string, results::CaseResult> results;
  double seconds = 0;
};

/// `{folder}` in the command is a folder of this run.
inline SuiteRun run_trial(Trial trial, const std::string& folder) {
  const auto start = std::chrono::steady_clock::now();
  constexpr std::string_view mark = "{folder}";
  if (const std::size_t at = trial.device.find(mark); at != std::string::npos)
    trial.device.replace(at, mark.size(), folder);
  if (!trial.device.starts_with("tcp:")) trial.device.insert(0, "exec:");
  std::vector<std::string> arguments{"run",         "--endpoint",  trial.device,
                                     "--profile",   trial.profile, "--allow-write",
                                     "all,P,Q,U,H", "--out",       folder};
  if (!trial.vectors.empty()) arguments.insert(arguments.end(), {"--vectors", trial.vectors});
  if (!trial.filter.empty()) arguments.insert(arguments.end(), {"--filter", trial.filter});
  if (!trial.waivers.empty()) arguments.insert(arguments.end(), {"--waivers", trial.waivers});
  std::filesystem::create_directories(folder);
  SuiteRun run;
  // The whole suite under sanitizers on a busy machine.
  run.tool = tool_tests::Process(tool_tests::tool_arguments(std::move(arguments)))
                 .wait(tool_tests::Process::Limit(280));
  const Result<results::RunLog> log = results::read_ndjson(
      folder + "/results.ndjson",
      [&run](const results::CaseResult& result) { run.results.emplace(result.id, result); });
  if (!log) run.tool.err += log.error().message;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

/// Runs the trial of each test that GoogleTest has selected, several at once, before the tests ask
/// for the results.
class SuiteRuns : public testing::Environment {
 public:
  /// The trial of a test ("Catches/late_answer"), if it has one.
  using TrialOf = std::function<std::optional<Trial>(const std::string& test)>;
  explicit SuiteRuns(TrialOf trial_of) : trial_of_(std::move(trial_of)) {}

  void SetUp() override {
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    for (int i = 0; i < tests.total_test_suite_count(); ++i) {
      const testing::TestSuite& suite = *tests.GetTestSuite(i);
      for (int j = 0; j < suite.total_test_count(); ++j)
        if (suite.GetTestInfo(j)->should_run()) add(trial_of_(suite.GetTestInfo(j)->name()));
    }
    constexpr std::size_t at_once = 6;
    for (std::size_t i = 0; i < at_once; ++i) workers_.emplace_back([this] { work(); });
  }

  void TearDown() override {
    workers_.clear();
    for (const std::string& line : table_) fmt::print("{}\n", line);
  }

  SuiteRun take(const std::string& trial) { return runs_.at(trial).get_future().get(); }
  /// A line for the table at the end.
  void report(std::string line) { table_.push_back(std::move(line)); }

 private:
  void add(std::optional<Trial> trial) {
    if (!trial || !runs_.try_emplace(trial->name).second) return;
    // The whole suite first: it takes longest.
    queue_.insert(trial->vectors.empty() ? queue_.begin() : queue_.end(), std::move(*trial));
  }

  void work() {
    for (std::size_t i; (i = next_++) < queue_.size();)
      runs_.at(queue_[i].name).set_value(run_trial(queue_[i], folder_ / queue_[i].name));
  }

  TrialOf trial_of_;
  tool_tests::TestFolder folder_;
  std::vector<Trial> queue_;
  std::map<std::string, std::promise<SuiteRun>> runs_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::string> table_;
  std::vector<std::jthread> workers_;  // last: they end before what they use
};

/// What stands behind the last slash of a parametrised test's name.
inline std::string parameter_of(const std::string& test) {
  const std::size_t slash = test.rfind('/');
  return slash == std::string::npos ? std::string() : test.substr(slash + 1);
}

/// Filter of the cases that are made of the same vector as `id`.
inline std::string neighbours_of(const std::string& id) {
  return std::count(id.begin(), id.end(), '/') > 2 ? id.substr(0, id.rfind('/')) + "/*" : id;
}

/// The line of the verdict, or a field that it shows as different.
inline bool names(const results::CaseResult& result, std::string_view what) {
  if (result.message.find(what) != std::string::npos) return true;
  return std::ranges::any_of(result.differences, [what](const results::Difference& one) {
    return one.field.find(what) != std::string::npos;
  });
}

/// The case must have failed, and its message, which is returned, must name the fault.
inline std::string expect_caught(const SuiteRun& run, const std::string& id,
                                 std::string_view message) {
  // Of one that is still sending when the run ends, that is trouble beside its failures.
  const bool sends_on =
      run.tool.code == 3 && run.tool.err.find("does not end") != std::string::npos;
  EXPECT_TRUE(run.tool.code == 1 || sends_on) << run.tool.code << run.tool.out << run.tool.err;
  const auto found = run.results.find(id);
  if (found == run.results.end()) {
    ADD_FAILURE() << id << " did not run\n" << run.tool.out << run.tool.err;
    return {};
  }
  const results::CaseResult& result = found->second;
  EXPECT_EQ(result.verdict, results::Verdict::fail) << id << ": " << result.message;
  EXPECT_TRUE(names(result, message))
      << "the message does not name '" << message << "': " << result.message;
  EXPECT_NE(run.tool.out.find(result.section), std::string::npos)
      << "the clause is not in the block of the case";
  return result.message;
}

/// Nothing may fail, and at least `enough` cases pass.
inline std::size_t expect_healthy(const SuiteRun& run, std::size_t enough) {
  EXPECT_EQ(run.tool.code, 0) << run.tool.out << run.tool.err;
  std::size_t passed = 0;
  for (const auto& [id, result] : run.results) {
    passed += result.verdict == results::Verdict::pass;
    EXPECT_FALSE(result.verdict == results::Verdict::fail ||
                 result.verdict == results::Verdict::error)
        << id << ": " << result.message;
  }
  EXPECT_GT(passed, enough);
  return passed;
}

}  // namespace fieldproof::broken
