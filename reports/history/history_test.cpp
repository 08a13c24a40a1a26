#include "reports/history/history.hpp"

#include <gmock/gmock.h>
#include <sqlite3.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "reports/history/test_runs.hpp"

namespace fieldproof::history {
namespace {

using test::add_or_fail;
using test::file_of;
using test::open_or_fail;
using test::result_of;
using test::run_of;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using V = results::Verdict;

class HistoryTest : public testing::Test {
 protected:
  /// By SQLite itself, as another program would.
  void execute(const std::string& sql) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(path_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }
  std::string error_of_open(Use use) const {
    const Result<History> history = History::open(path_, use);
    return history ? "none" : history.error().message;
  }
  samples::Folder folder_;
  const std::string path_ = folder_ / "sub/history.sqlite";
};

TEST_F(HistoryTest, ARunComesBackAsItWasCompared) {
  compare::ResultFile file = file_of(
      {}, {result_of("rss/one", V::pass, {4.2080001, 0.000001, 1e6}),
           result_of("rss/two", V::fail, {12.5}, "BCC: expected 0F, received 09"),
           result_of("rss/two", V::pass, {4.0}), result_of("wss/x", V::skip, {}, "no WSS")});
  file.results[0].rev = 3;
  file.results[0].recording.link_floor = 250us;
  file.results[2].repeat = 1;
  const compare::RunSummary run = compare::summarize(file);
  History history = open_or_fail(path_);
  const Result<compare::RunSummary> back = history.summary(add_or_fail(history, run));
  ASSERT_TRUE(back) << back.error().message;
  ASSERT_EQ(back->cases.size(), run.cases.size());
  for (const auto& [name, one] : run.cases) {
    SCOPED_TRACE(name);
    const compare::CaseSummary& now = back->cases.at(name);
    EXPECT_EQ(now.verdict, one.verdict);
    EXPECT_EQ(now.message, one.message);
    EXPECT_EQ(now.title, one.title);
    EXPECT_EQ(now.section, one.section);
    EXPECT_EQ(now.rev, one.rev);
    EXPECT_EQ(now.repetitions, one.repetitions);
    EXPECT_EQ(now.with_verdict, one.with_verdict);
    EXPECT_EQ(now.timing_floor_ms, one.timing_floor_ms);
    ASSERT_EQ(now.response_ms.size(), one.response_ms.size());
    for (std::size_t i = 0; i < one.response_ms.size(); ++i)
      EXPECT_NEAR(now.response_ms[i], one.response_ms[i], 1e-6) << "to a nanosecond";
  }
  EXPECT_EQ(back->run.identity, run.run.identity);
  EXPECT_EQ(back->run.properties, run.run.properties);
  EXPECT_EQ(back->tally, run.tally);
  EXPECT_EQ(back->end->finished, run.end->finished);
  const compare::ComparisonSet set({*back, run});
  EXPECT_EQ(set.comparisons[0].unchanged, 3u) << "nothing changed on the way";
}

TEST_F(HistoryTest, ARunStandsOnce) {
  History history = open_or_fail(path_);
  const compare::RunSummary run = run_of({}, {result_of("rss/one", V::pass, {4.2})});
  EXPECT_EQ(add_or_fail(history, run), 1);
  const Result<History::Added> again = open_or_fail(path_).add(run);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->number, 1);
  EXPECT_FALSE(again->is_new);
  EXPECT_EQ(add_or_fail(history, run_of({}, {result_of("rss/one", V::pass, {4.3})})), 2)
      << "the same second, another time";
  EXPECT_EQ(add_or_fail(history, run_of({}, {result_of("rss/one", V::fail, {4.2})})), 3);
  EXPECT_EQ(history.runs()->size(), 3u);
}

TEST_F(HistoryTest, RunsAreInTheOrderOfTimeWhateverTheOrderOfAdding) {
  History history = open_or_fail(path_);
  add_or_fail(history, run_of({.day = 3}, {result_of("a", V::pass)}));
  add_or_fail(history, run_of({.day = 1, .serial = "8"}, {result_of("a", V::fail)}));
  add_or_fail(history, run_of({.day = 2}, {result_of("a", V::pass)}));
  std::vector<std::string> found;
  const auto runs = history.runs();
  for (const RunEntry& run : *runs)
    found.push_back(
        fmt::format("{} {} {} red {}", run.number, run.started.substr(0, 10), run.device, run.red));
  EXPECT_THAT(found, ElementsAre("2 2026-01-01 LS XBC, serial number 8 red 1",
                                 "3 2026-01-02 LS XBC, serial number 7 red 0",
                                 "1 2026-01-03 LS XBC, serial number 7 red 0"));
  EXPECT_EQ(history.runs("LS XBC, serial number 7")->size(), 2u);
}

TEST_F(HistoryTest, TheLastRunIsOfTheSameDeviceAndCameToItsEnd) {
  History history = open_or_fail(path_);
  const std::vector<results::CaseResult> one{result_of("a", V::fail)};
  const compare::RunSummary now = run_of({.firmware = "V1.41", .day = 9}, one);
  EXPECT_EQ(*history.last_before(now), std::nullopt) << "none yet";
  add_or_fail(history, run_of({.day = 2}, one));
  add_or_fail(history, run_of({.day = 3, .serial = "8"}, one));
  add_or_fail(history, run_of({.day = 10}, one));
  compare::RunSummary killed = run_of({.day = 4}, one), other = run_of({.day = 5}, one);
  killed.end.reset();
  add_or_fail(history, killed);
  other.run.properties["protocol"] = "modbus-rtu";
  add_or_fail(history, other);
  add_or_fail(history, now);
  const auto last = history.last_before(now);
  ASSERT_TRUE(last && *last) << "and neither itself nor a later one";
  EXPECT_EQ((*last)->path, path_ + ", run 1");
}

TEST_F(HistoryTest, WhatSaysTooLittleIsNotAdded) {
  History history = open_or_fail(path_);
  const auto refused = [&](const compare::RunSummary& run) {
    const auto added = history.add(run);
    return added ? "added" : added.error().message;
  };
  compare::RunSummary run = run_of({.vectors = ""}, {result_of("a", V::pass)});
  EXPECT_EQ(refused(run),
            "cannot add results.ndjson: it does not say which vectors it is of; give "
            "results.ndjson or results.json");
  run = run_of({}, {result_of("a", V::pass)});
  run.run.started = "yesterday";
  EXPECT_THAT(refused(run), HasSubstr("it does not say when it was"));
  EXPECT_THAT(refused(run_of({}, {})), HasSubstr("there is no result in it"));
  EXPECT_THAT(*history.runs(), IsEmpty());
}

TEST_F(HistoryTest, ReadsNoFileThatIsNotThere) {
  EXPECT_THAT(error_of_open(Use::read),
              AllOf(StartsWith("cannot read history " + path_ + ": there is none"),
                    HasSubstr("`fieldproof history add RESULT` makes it")));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

/// What is no history of ours, or of a newer tool, is the same byte for byte afterwards.
TEST_F(HistoryTest, RefusesForeignFilesAndLeavesThemAlone) {
  std::filesystem::create_directories(folder_ / "sub");
  const auto expect_refused = [&](const std::string& cause) {
    const std::string before = samples::read_file(path_);
    EXPECT_THAT(error_of_open(Use::write),
                AllOf(StartsWith("cannot write history " + path_), HasSubstr(cause)));
    EXPECT_THAT(error_of_open(Use::read),
                AllOf(StartsWith("cannot read history " + path_), HasSubstr(cause)));
    EXPECT_EQ(samples::read_file(path_), before);
  };
  std::ofstream(path_) << "{\"run\":{}}\n" << std::string(4096, ' ');
  expect_refused("it is no SQLite file; name another with --history");
  std::filesystem::remove(path_);
  execute("CREATE TABLE mine (x); INSERT INTO mine VALUES (1)");
  expect_refused("it is no history of fieldproof; name another with --history");
  std::filesystem::remove(path_);
  open_or_fail(path_);
  execute("PRAGMA user_version = 2");
  expect_refused(
      "its version is 2, this tool knows 1; use the fieldproof that wrote it, or a newer one");
}

TEST_F(HistoryTest, ADamagedFileIsNamedAndNotWrittenTo) {
  {
    History history = open_or_fail(path_);
    for (int day = 1; day <= 28; ++day) {
      std::vector<results::CaseResult> results;
      for (int i = 0; i < 40; ++i)
        results.push_back(result_of(fmt::format("case_{}", i), V::pass, {day + i / 7.0}));
      add_or_fail(history, run_of({.day = day}, std::move(results)));
    }
  }
  const std::string whole = samples::read_file(path_);
  ASSERT_GT(whole.size(), 40'000u);
  const auto with = [&](const std::string& bytes) {
    std::ofstream(path_, std::ios::binary) << bytes;
    std::string message = error_of_open(Use::write);
    if (message == "none") {
      const auto added = open_or_fail(path_).add(run_of({.day = 40}, {result_of("a", V::pass)}));
      message = added ? "added" : added.error().message;
    }
    EXPECT_EQ(samples::read_file(path_), bytes);
    return message;
  };
  EXPECT_THAT(with(whole.substr(0, whole.size() / 2)),
              AllOf(StartsWith("cannot write history " + path_ + ": it is damaged"),
                    HasSubstr("nothing was written to it"), HasSubstr(".recover")));
  std::string overwritten = whole;
  overwritten.replace(4096, 30'000, std::string(30'000, '\xA5'));
  EXPECT_THAT(with(overwritten), HasSubstr("it is damaged"));
}

TEST_F(HistoryTest, NoticesAListThatIsNotWhatItsHashSays) {
  History history = open_or_fail(path_);
  const std::int64_t run = add_or_fail(history, run_of({}, {result_of("a", V::pass, {4.2})}));
  execute("UPDATE list SET bytes = x'02' WHERE id = (SELECT verdicts FROM run)");
  const auto read = history.summary(run);
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("it is damaged"));
}

/// Two programs at once, from before there is a file.
TEST_F(HistoryTest, WritersAtOnceAreAllKept) {
  constexpr int writers = 4, each = 8;
  std::vector<std::thread> threads;
  for (int w = 0; w < writers; ++w)
    threads.emplace_back([this, w] {
      History history = open_or_fail(path_);
      for (int i = 1; i <= each; ++i)
        add_or_fail(history, run_of({.day = i, .serial = std::to_string(w)},
                                    {result_of("a", V::pass), result_of("b", V::fail)}));
    });
  for (std::thread& one : threads) one.join();
  EXPECT_EQ(open_or_fail(path_).runs()->size(), std::size_t{writers * each});
}

/// A file that may not grow stands for a full disk: what was there stays.
TEST_F(HistoryTest, AFullDiskIsNamedAndLosesNothing) {
  {
    History history = open_or_fail(path_);
    add_or_fail(history, run_of({}, {result_of("a", V::pass)}));
  }
  std::vector<results::CaseResult> many;
  for (int i = 0; i < 3000; ++i)
    many.push_back(result_of(fmt::format("case_{}", i), V::pass, {i / 7.0}));
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  rlimit small = old;
  small.rlim_cur = std::filesystem::file_size(path_) + 8192;
  std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  const auto added = open_or_fail(path_).add(run_of({.day = 2}, std::move(many)));
  setrlimit(RLIMIT_FSIZE, &old);
  ASSERT_FALSE(added);
  EXPECT_THAT(added.error().message,
              AllOf(StartsWith("cannot write history " + path_), HasSubstr("file too large")));
  EXPECT_EQ(open_or_fail(path_).runs()->size(), 1u);
}

TEST_F(HistoryTest, APlaceThatCannotBeWrittenIsNamed) {
  const auto error_at = [](const std::string& path) {
    const Result<History> history = History::open(path, Use::write);
    return history ? "none" : history.error().message;
  };
  EXPECT_THAT(error_at("/proc/history.sqlite"),
              StartsWith("cannot write history /proc/history.sqlite: no such file or directory"));
  EXPECT_THAT(error_at(folder_ / ""), AllOf(HasSubstr("is a directory"), HasSubstr("name a file")));
}

TEST(HistoryPath, FollowsTheUsersDataDirectory) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("XDG_DATA_HOME", "/data", 1);
  EXPECT_EQ(*default_path(), "/data/fieldproof/history.sqlite");
  unsetenv("XDG_DATA_HOME");
  setenv("HOME", "/home/kim", 1);
  EXPECT_EQ(*default_path(), "/home/kim/.local/share/fieldproof/history.sqlite");
  unsetenv("HOME");
  EXPECT_THAT(default_path().error().message, HasSubstr("name a file with --history"));
  setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace fieldproof::history
