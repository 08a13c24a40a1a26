#include "harness/bench/runner.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <map>
#include <stdexcept>

#include "reports/results/shard.hpp"

namespace fieldproof::bench {

namespace {

struct Context {
  const RunCase* run = nullptr;
  int repeat = 0;
  std::size_t handed_over = 0;
  bool stopped = false;
};

class CaseTest : public testing::Test {
 public:
  CaseTest(const vectors::Case& source, Context& context) : source_(source), context_(context) {}

  void TestBody() override {
    if (context_.stopped) return;
    ++context_.handed_over;
    context_.stopped = !(*context_.run)(source_, context_.repeat);
  }

 private:
  const vectors::Case& source_;
  Context& context_;
};

class Repetitions : public testing::EmptyTestEventListener {
 public:
  explicit Repetitions(Context& context) : context_(context) {}
  void OnTestIterationStart(const testing::UnitTest&, int iteration) override {
    context_.repeat = iteration;
    // GoogleTest has no way to end its repetitions early; an exception of a listener ends
    // RUN_ALL_TESTS, and is caught there.
    if (context_.stopped) throw std::runtime_error("stopped");
  }

 private:
  Context& context_;
};

void initialize(const RunnerOptions& options) {
  if (const auto shard = results::shard_of_environment()) results::hand_to_googletest(*shard);
  // Selection, repetition and reports are ours, whatever GTEST_FILTER and its like say in the
  // environment.
  std::vector<std::string> arguments{"fieldproof",
                                     "--gtest_color=no",
                                     "--gtest_filter=*",
                                     "--gtest_output=",
                                     "--gtest_fail_fast=0",
                                     "--gtest_also_run_disabled_tests=1",
                                     "--gtest_catch_exceptions=1",
                                     fmt::format("--gtest_repeat={}", options.repeat)};
  if (options.shuffle) {
    arguments.push_back("--gtest_shuffle");
    arguments.push_back(
        fmt::format("--gtest_random_seed={}", options.seed % 100'000));  // what GoogleTest takes
  }
  arguments.insert(arguments.end(), options.gtest_arguments.begin(), options.gtest_arguments.end());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  int argc = static_cast<int>(arguments.size());
  testing::InitGoogleTest(&argc, argv.data());
}

/// "xgt_cnet/rss/two_words" is test "two_words" of suite "xgt_cnet/rss".
std::pair<std::string, std::string> split_id(const std::string& id) {
  const std::size_t first = id.find('/');
  const std::size_t second = id.find('/', first + 1);
  const std::size_t cut = second == std::string::npos ? first : second;
  return {id.substr(0, cut), id.substr(cut + 1)};
}

/// GoogleTest puts the tests of one suite together, wherever they are registered: a section that
/// comes again is another suite, so that the cases keep their order.
class SuiteNames {
 public:
  std::string next(const std::string& section) {
    if (section != last_) ++times_[section];
    last_ = section;
    const int times = times_[section];
    return times == 1 ? section : fmt::format("{}#{}", section, times);
  }

 private:
  std::string last_;
  std::map<std::string, int> times_;  // how often it has begun
};

}  // namespace

std::size_t run_with_gtest(const std::vector<const vectors::Case*>& cases,
                           const RunnerOptions& options, const RunCase& run) {
  initialize(options);
  Context context{&run};
  SuiteNames suites;
  for (const vectors::Case* source : cases) {
    const auto [section, name] = split_id(source->id);
    const std::string suite = suites.next(section);
    testing::RegisterTest(
        suite.c_str(), name.c_str(), nullptr, nullptr, source->file.c_str(), 1,
        [source, &context]() -> testing::Test* { return new CaseTest(*source, context); });
  }
  testing::TestEventListeners& listeners = testing::UnitTest::GetInstance()->listeners();
  delete listeners.Release(listeners.default_result_printer());
  listeners.Append(new Repetitions(context));
  [[maybe_unused]] const int ignored = RUN_ALL_TESTS();
  return context.handed_over;
}

}  // namespace fieldproof::bench
