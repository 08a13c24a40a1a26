// The suite against broken devices: each fault must turn its case red, with a message that names it, and the healthy
// device must pass. Everything runs as a user would: the built tool, the device in a process of its own, a pty between.
// Most of the time of a run is waiting, so several run at once.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <future>
#include <map>
#include <thread>

#include "harness/cli/tool.hpp"
#include "harness/results/ndjson.hpp"
#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet {

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

using testing::HasSubstr;

constexpr std::size_t at_once = 6;
constexpr std::string_view healthy = "none";
constexpr Process::Limit longest_run{280};  // the whole suite under sanitizers on a busy machine

std::string case_id(const Fault& fault) { return fmt::format("xgt_cnet/{}", fault.caught_by); }

/// The case and its neighbours: what else is made of the same vector.
std::string filter_of(const Fault& fault) {
  const std::string id = case_id(fault);
  if (fault.neighbours == alone) return id;
  if (!fault.neighbours.empty()) return std::string(fault.neighbours);
  const bool one_of_many = std::count(id.begin(), id.end(), '/') > 2;
  return one_of_many ? id.substr(0, id.rfind('/')) + "/*" : id;
}

/// The vectors of a case: one file a chapter, which loads faster than all.
std::string vectors_of(const Fault& fault) {
  const std::string_view chapter = fault.caught_by.substr(0, fault.caught_by.find('/'));
  return fmt::format("{}/vectors/xgt_cnet/{}.json", FIELDPROOF_SOURCE_DIR, chapter);
}

struct SuiteRun {
  Finished tool;
  std::map<std::string, CaseResult> results;
  double seconds = 0;
};

/// `fault` nullptr: the healthy device and the whole suite.
SuiteRun run_suite(const Fault* fault, const std::string& folder) {
  const auto start = std::chrono::steady_clock::now();
  const unsigned station = fault ? fault->station : 1;
  const std::string device = fmt::format("{} {} {{tty}} {} {}", quoted(BROKEN_SERVER), fault ? fault->name : healthy, station,
                                         quoted(folder + "/storage"));
  std::vector<std::string> arguments{"run",       "--endpoint", fmt::format("exec:{}?station={}", device, station),
                                     "--profile", "xbc-h",      "--allow-write",
                                     "all,P,Q,U", "--out",      folder};
  if (fault) arguments.insert(arguments.end(), {"--vectors", vectors_of(*fault), "--filter", filter_of(*fault)});
  std::filesystem::create_directories(folder);
  SuiteRun run;
  run.tool = Process(tool_arguments(std::move(arguments))).wait(longest_run);
  const Result<RunLog> log =
      read_ndjson(folder + "/results.ndjson", [&run](const CaseResult& result) { run.results.emplace(result.id, result); });
  if (!log) run.tool.err += log.error().message;
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return run;
}

/// Runs the suite for each test that GoogleTest has selected, several at once, before the tests ask for the results.
class SuiteRuns : public testing::Environment {
 public:
  void SetUp() override {
    const testing::UnitTest& tests = *testing::UnitTest::GetInstance();
    for (int i = 0; i < tests.total_test_suite_count(); ++i) {
      const testing::TestSuite& suite = *tests.GetTestSuite(i);
      for (int j = 0; j < suite.total_test_count(); ++j)
        if (suite.GetTestInfo(j)->should_run()) add(suite.GetTestInfo(j)->name());
    }
    for (std::size_t i = 0; i < at_once; ++i) workers_.emplace_back([this] { work(); });
  }

  void TearDown() override {
    workers_.clear();
    for (const std::string& line : table_) fmt::print("{}\n", line);
  }

  SuiteRun take(std::string_view fault) { return runs_.at(std::string(fault)).get_future().get(); }
  void report(std::string line) { table_.push_back(std::move(line)); }

 private:
  /// "Catches/late_answer", or a test of the healthy device.
  void add(const std::string& test) {
    const std::size_t slash = test.rfind('/');
    if (slash == std::string::npos && test != "PassesTheWholeSuite") return;
    const std::string fault = slash == std::string::npos ? std::string(healthy) : test.substr(slash + 1);
    if (!runs_.try_emplace(fault).second) return;
    queue_.insert(fault == healthy ? queue_.begin() : queue_.end(), fault);  // the longest first
  }

  void work() {
    for (std::size_t i; (i = next_++) < queue_.size();) {
      const std::string& name = queue_[i];
      runs_.at(name).set_value(run_suite(find_fault(name), folder_ / name));
    }
  }

  TestFolder folder_;
  std::vector<std::string> queue_;
  std::map<std::string, std::promise<SuiteRun>> runs_;
  std::atomic<std::size_t> next_{0};
  std::vector<std::string> table_;
  std::vector<std::jthread> workers_;  // last: they end before what they use
};

SuiteRuns& runs() {
  static auto* const environment = static_cast<SuiteRuns*>(testing::AddGlobalTestEnvironment(new SuiteRuns));
  return *environment;
}
[[maybe_unused]] const SuiteRuns& registered_before_main = runs();

/// The line of the verdict, or a field that it shows as different.
bool names(const CaseResult& result, std::string_view what) {
  if (result.message.find(what) != std::string::npos) return true;
  return std::ranges::any_of(result.differences,
                             [what](const Difference& one) { return one.field.find(what) != std::string::npos; });
}

class TheSuite : public testing::TestWithParam<Fault> {};

TEST_P(TheSuite, Catches) {
  const Fault& fault = GetParam();
  const SuiteRun run = runs().take(fault.name);
  EXPECT_EQ(run.tool.code, 1) << run.tool.out << run.tool.err;
  const auto found = run.results.find(case_id(fault));
  ASSERT_NE(found, run.results.end()) << case_id(fault) << " did not run\n" << run.tool.out << run.tool.err;
  const CaseResult& result = found->second;
  EXPECT_EQ(result.verdict, Verdict::fail) << result.id << ": " << result.message;
  EXPECT_TRUE(names(result, fault.message)) << "the message does not name '" << fault.message << "': " << result.message;
  EXPECT_THAT(run.tool.out, HasSubstr(result.section)) << "the clause is not in the block of the case";
  runs().report(fmt::format("{:<40} {:<54} {:>4.1f} s  {}", fault.name, fault.caught_by, run.seconds, result.message));
}

INSTANTIATE_TEST_SUITE_P(Broken, TheSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyDevice, PassesTheWholeSuite) {
  const SuiteRun run = runs().take(healthy);
  EXPECT_EQ(run.tool.code, 0) << run.tool.out << run.tool.err;
  std::size_t passed = 0;
  for (const auto& [id, result] : run.results) {
    passed += result.verdict == Verdict::pass;
    EXPECT_FALSE(result.verdict == Verdict::fail || result.verdict == Verdict::error) << id << ": " << result.message;
  }
  EXPECT_GT(passed, 1000u);
  runs().report(fmt::format("{:<40} {} of {} cases pass, {:.1f} s", healthy, passed, run.results.size(), run.seconds));
}

TEST(FaultTable, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const Fault& fault : faults()) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults().size(), 100u);
}

TEST(BrokenServer, ListsItsFaults) {
  const Finished list = run_program({BROKEN_SERVER, "--list"});
  EXPECT_EQ(list.code, 0) << list.err;
  for (const Fault& fault : faults()) EXPECT_THAT(list.out, HasSubstr(fault.name));
}

TEST(BrokenServer, AnUnknownFaultIsAnErrorThatNamesTheNearest) {
  const TestFolder folder;
  const Finished ended = run_program({BROKEN_SERVER, "bcc_off_by_on", folder / "tty"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("bcc_off_by_one"));
}

}  // namespace
}  // namespace fieldproof::xgt_cnet
