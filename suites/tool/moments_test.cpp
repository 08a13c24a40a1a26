// Whatever happens in the middle of a run, and at whichever moment: its reports are whole, or they
// are not there, and the exit code says it. moments/moments.cpp makes it happen.
#include <gmock/gmock.h>

#include <random>

#include "suites/tool/at_moment.hpp"
#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// Each line is JSON; the last may be cut short where the run was killed.
void expect_whole_lines(const std::string& path, bool killed) {
  std::string text = read_text(path);
  if (killed) text.resize(text.rfind('\n') + 1);
  EXPECT_TRUE(text.empty() || text.ends_with('\n')) << path;
  for (const std::string& line : text_lines(text))
    EXPECT_TRUE(nlohmann::json::accept(line)) << path << ": " << line;
}

class Moments : public testing::Test {
 protected:
  Finished run(int moment, const std::string& act, const std::vector<std::string>& more = {}) {
    fs::remove_all(out_);
    std::vector<std::string> arguments{"run", "--vectors", vectors_, "--out", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(arguments, {.environment = at_moment(moment, act), .folder = ""});
  }

  /// Of a run in which nothing happens, every third by seed, the first among them.
  const std::vector<int>& moments() {
    static const std::vector<int> chosen = [this] {
      const Finished undisturbed = run(0, "count");
      EXPECT_EQ(undisturbed.code, 0) << undisturbed.err;
      const int all = std::atoi(undisturbed.err.substr(undisturbed.err.rfind(' ') + 1).c_str());
      EXPECT_GT(all, cases + 3) << "a line each, and the reports";
      std::mt19937 random(15);
      std::vector<int> picked{1};
      for (int at = 2; at <= all; at += 3)
        picked.push_back(std::min(all, at + static_cast<int>(random() % 3)));
      return picked;
    }();
    return chosen;
  }

  bool is_there(const char* report) const { return fs::exists(out_ + '/' + report); }
  void expect_whole_or_absent(bool killed = false) const {
    expect_whole_lines(out_ + "/results.ndjson", killed);
    EXPECT_TRUE(!is_there("results.json") ||
                nlohmann::json::accept(read_text(out_ + "/results.json")));
    if (is_there("junit.xml")) expect_valid_junit(out_ + "/junit.xml");
    EXPECT_TRUE(!is_there("report.html") ||
                read_text(out_ + "/report.html").ends_with("</html>\n"));
    if (killed || !fs::exists(out_)) return;
    for (const fs::directory_entry& one : fs::directory_iterator(out_))
      EXPECT_NE(one.path().extension(), ".part") << one.path() << " is left";
  }

  static constexpr int cases = 12;
  TestFolder folder_;
  const std::string out_ = folder_ / "out", vectors_ = write_vectors(folder_, many_vectors(cases));
};

TEST_F(Moments, ASignalAtAnyOfThemLeavesWholeReports) {
  for (const int signal : {SIGTERM, SIGINT})
    for (const int moment : moments()) {
      SCOPED_TRACE(moment);
      const Finished finished = run(moment, "signal:" + std::to_string(signal));
      EXPECT_EQ(finished.code, moment <= cases ? 130 : 0) << "what is judged is judged";
      EXPECT_EQ(finished.code == 130, finished.out.find("exit 130") != std::string::npos);
      expect_whole_or_absent();
      expect_reports(out_);
    }
}

TEST_F(Moments, AKillAtAnyOfThemLeavesWholeReportsOrNone) {
  for (const int moment : moments()) {
    SCOPED_TRACE(moment);
    const Finished finished = run(moment, "signal:9");
    EXPECT_EQ(finished.code, 128 + SIGKILL);
    expect_whole_or_absent(true);
    if (!fs::exists(out_ + "/results.ndjson") || read_text(out_ + "/results.ndjson").empty())
      continue;
    const Finished report = run_tool({"report", out_ + "/results.ndjson", "--json",
                                      out_ + "/results.json", "--junit", out_ + "/junit.xml"});
    EXPECT_EQ(report.code, 0) << report.err;
    expect_reports(out_);
  }
}

/// Whatever is full, gone or locked in the middle of a run: exit 3, and the message says what could
/// not be written and why.
TEST_F(Moments, AFullDiskAtAnyOfThemIsTroubleThatIsNamed) {
  for (const int moment : moments()) {
    if (moment == moments().back()) continue;  // the last report takes its name: that needs no room
    SCOPED_TRACE(moment);
    const Finished finished = run(moment, "full");
    EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
    EXPECT_THAT(finished.err,
                AllOf(HasSubstr("cannot write " + out_), HasSubstr("no space left on device")));
    expect_whole_or_absent();
  }
}

/// The file of results is open already; the reports have no place.
TEST_F(Moments, AFolderThatVanishesIsTroubleThatIsNamed) {
  for (const int moment : moments()) {
    SCOPED_TRACE(moment);
    const Finished finished = run(moment, "remove:" + out_);
    EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("cannot write " + out_));
    EXPECT_FALSE(fs::exists(out_));
  }
}

TEST_F(Moments, AFolderThatIsLockedIsTroubleThatIsNamed) {
  for (const int moment : moments()) {
    SCOPED_TRACE(moment);
    const Finished finished = run(moment, "lock:" + out_);
    fs::permissions(out_, fs::perms::owner_all);
    EXPECT_EQ(finished.code, 3) << finished.out << finished.err;
    EXPECT_THAT(finished.err, HasSubstr("cannot write " + out_));
    expect_whole_or_absent(true);  // what was begun there cannot be removed either
  }
}

/// Times of the day are shown, never counted with: a day that comes twice changes no verdict.
TEST_F(Moments, AClockThatIsSetBackChangesNothing) {
  for (const int moment : {2, 8}) {
    const Finished finished = run(moment, "clock");
    EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
    expect_reports(out_);
    const Results results = read_results(out_ + "/results.ndjson");
    EXPECT_LT(results.end.at("finished").get<std::string>(),
              results.run.at("started").get<std::string>())
        << "the test itself";
    EXPECT_GE(results.end.at("seconds").get<double>(), 0);
  }
  const Finished soak = run(5, "clock", {"--duration", "300ms"});
  EXPECT_EQ(soak.code, 0) << soak.out << soak.err;
  expect_reports(out_);
  EXPECT_EQ(run_tool({"history", "add", out_ + "/results.ndjson", "--history", folder_ / "h"}).code,
            0);
}

}  // namespace
}  // namespace fieldproof::tool_tests
