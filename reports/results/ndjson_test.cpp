#include "reports/results/ndjson.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "reports/results/whole_file.hpp"

namespace fieldproof::results {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Ndjson : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "results.ndjson").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  void store(const std::string& text) const { std::ofstream(path_, std::ios::binary) << text; }

  std::string content() const {
    const Result<std::string> text = read_whole_file(path_);
    return text ? *text : "";
  }

  Result<RunLog> read() {
    ids_.clear();
    return read_ndjson(path_, [this](const CaseResult& result) { ids_.push_back(result.id); });
  }

  std::string read_error() {
    auto log = read();
    return log ? "" : log.error().message.substr(log.error().message.find(path_) + path_.size());
  }

  static CaseResult result(const std::string& id) {
    CaseResult made;
    made.id = id;
    made.verdict = Verdict::pass;
    return made;
  }

  static constexpr const char* run_line =
      "{\"run\":{\"tool_version\":\"0.1.0\",\"started\":\"2026-11-21T12:00:00Z\"}}\n";
  static constexpr const char* case_line = "{\"case\":{\"id\":\"a/b\",\"verdict\":\"PASS\"}}\n";
  static constexpr const char* end_line = "{\"end\":{\"exit_code\":0}}\n";

  std::filesystem::path folder_;
  std::string path_;
  std::vector<std::string> ids_;
};

TEST_F(Ndjson, WhatIsWrittenIsRead) {
  {
    auto writer = NdjsonWriter::create(path_);
    ASSERT_TRUE(writer) << writer.error().message;
    ASSERT_TRUE(
        writer->begin(RunInfo{"0.1.0", "2026-11-21T12:00:00Z", "emulator:", "", "", "", {}}));
    ASSERT_TRUE(writer->add(Delivery(result("a/one"))));
    ASSERT_TRUE(writer->add(Delivery(result("a/two"))));
    RunLog log;
    log.end = RunEnd{"2026-11-21T12:00:01Z", 1, 0, false, ""};
    ASSERT_TRUE(writer->end(log));
  }
  auto log = read();
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_EQ("emulator:", log->run.endpoint);
  EXPECT_THAT(ids_, ElementsAre("a/one", "a/two"));
  EXPECT_EQ(2u, log->results);
  EXPECT_FALSE(log->truncated);
  ASSERT_TRUE(log->end);
  EXPECT_EQ(1, log->end->seconds);
}

TEST_F(Ndjson, EachLineIsInTheFileAtOnce) {
  auto writer = NdjsonWriter::create(path_);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin(RunInfo{}));
  ASSERT_TRUE(writer->add(Delivery(result("a/one"))));
  const std::string text = content();
  EXPECT_EQ(2, std::count(text.begin(), text.end(), '\n'));
  EXPECT_TRUE(text.ends_with("}}\n"));
}

TEST_F(Ndjson, ARunStartsANewFile) {
  store("old\n");
  auto writer = NdjsonWriter::create(path_);
  ASSERT_TRUE(writer);
  EXPECT_EQ("", content());
}

TEST_F(Ndjson, TwoRunsDoNotShareAFile) {
  auto first = NdjsonWriter::create(path_);
  ASSERT_TRUE(first);
  ASSERT_TRUE(first->begin(RunInfo{}));
  auto second = NdjsonWriter::create(path_);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("another run writes it"));
  EXPECT_NE("", content()) << "the first run keeps its lines";
}

TEST_F(Ndjson, BytesThatAreNotUtf8DoNotStopARun) {
  auto writer = NdjsonWriter::create(path_);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin(RunInfo{}));
  auto broken = result("a/b");
  broken.message = "got \xFF\x05\xC3";
  ASSERT_TRUE(writer->add(Delivery(broken)));
  std::string message;
  ASSERT_TRUE(read_ndjson(path_, [&](const CaseResult& read) { message = read.message; }));
  EXPECT_EQ("got \xEF\xBF\xBD\x05\xEF\xBF\xBD", message);
}

TEST_F(Ndjson, AFullDiskLeavesWholeLines) {
  auto writer = NdjsonWriter::create(path_);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->begin(RunInfo{}));
  const std::string before = content();

  // A limit on the size of files stands in for the disk: the write takes what fits, then fails.
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old;
  small.rlim_cur = before.size() + 10;
  setrlimit(RLIMIT_FSIZE, &small);
  Status failed = writer->add(Delivery(result("a/one")));
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);

  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message, HasSubstr("cannot write " + path_));
  EXPECT_EQ(before, content());
  ASSERT_TRUE(writer->add(Delivery(result("a/two"))));
  ASSERT_TRUE(read());
  EXPECT_THAT(ids_, ElementsAre("a/two"));
}

TEST_F(Ndjson, AKilledRunIsReadAsFarAsItWent) {
  store(std::string(run_line) + case_line + "{\"case\":{\"id\":\"a/c\",\"ver");
  auto log = read();
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_TRUE(log->truncated);
  EXPECT_FALSE(log->end);
  EXPECT_THAT(ids_, ElementsAre("a/b"));
}

TEST_F(Ndjson, EveryTruncationIsTolerated) {
  const std::string whole = std::string(run_line) + case_line + end_line;
  const std::size_t head =
      std::string(run_line).size() - 1;  // the run line as JSON, less its line break
  for (std::size_t length = 0; length <= whole.size(); ++length) {
    store(whole.substr(0, length));
    EXPECT_EQ(length >= head, static_cast<bool>(read())) << length;
  }
}

TEST_F(Ndjson, ALastLineWithoutBreakCounts) {
  store(std::string(run_line) + "{\"case\":{\"id\":\"a/b\",\"verdict\":\"PASS\"}}");
  auto log = read();
  ASSERT_TRUE(log);
  EXPECT_FALSE(log->truncated);
  EXPECT_EQ(1u, log->results);
}

TEST_F(Ndjson, DamageNamesFileAndLine) {
  store(std::string(run_line) + "{\"case\":{\"id\n" + case_line);
  EXPECT_EQ(", line 2: it is not JSON; repair or remove the line", read_error());
  store(std::string(run_line) + case_line + "{\"case\":{\"id\":\"a/b\",\"verdict\":\"GREEN\"}}\n");
  EXPECT_THAT(read_error(),
              testing::AllOf(HasSubstr(", line 3: "), HasSubstr("unknown verdict 'GREEN'")));
  store(std::string(run_line) + "{\"cases\":{}}\n");
  EXPECT_EQ(", line 2: unknown key 'cases'; repair or remove the line", read_error());
  store(std::string(run_line) + "[]\n");
  EXPECT_EQ(", line 2: it is not one of run, case, sample, soak, end; repair or remove the line",
            read_error());
}

TEST_F(Ndjson, TheOrderOfLinesIsChecked) {
  store(case_line);
  EXPECT_THAT(read_error(), HasSubstr(", line 1: the line 'run' must be the first"));
  store(std::string(run_line) + run_line);
  EXPECT_THAT(read_error(), HasSubstr(", line 2: the line 'run' must be the first"));
  store(std::string(run_line) + end_line + case_line);
  EXPECT_THAT(read_error(), HasSubstr(", line 3: nothing may follow the line 'end'"));
}

TEST_F(Ndjson, FilesThatCannotBeUsedSayWhy) {
  EXPECT_THAT(read_error(), HasSubstr(": no such file or directory"));
  auto writer = NdjsonWriter::create((folder_ / "none" / "results.ndjson").string());
  ASSERT_FALSE(writer);
  EXPECT_THAT(writer.error().message, HasSubstr("check the path, and that its folder exists"));
  store("");
  EXPECT_EQ(": no complete line is in it; the run was killed before it began", read_error());
}

}  // namespace
}  // namespace fieldproof::results
