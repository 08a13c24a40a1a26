#include "reports/compare/result_file.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "reports/json_report.hpp"
#include "reports/junit.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::compare {

using results::Verdict;

namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string stored = FIELDPROOF_SOURCE_DIR "/reports/testdata/results-1";

class ResultFileTest : public testing::Test {
 protected:
  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  std::string error_of(const std::string& name, const std::string& text) {
    const Result<ResultFile> file = read_result_file(write(name, text));
    return file ? "no error" : file.error().message;
  }
  samples::Folder folder_;
};

/// Written by the version of 2026-11-21, before results kept what a replay needs.
TEST_F(ResultFileTest, StoredResultsStillLoad) {
  for (const char* kind : {".ndjson", ".json", ".xml"}) {
    const Result<ResultFile> file = read_result_file(stored + kind);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->results.size(), 6u) << kind;
    std::map<std::string, Verdict> verdicts;
    for (const results::CaseResult& result : file->results) verdicts[result.id] = result.verdict;
    EXPECT_EQ(verdicts,
              (std::map<std::string, Verdict>{{"xgt_cnet/old/alternative", Verdict::non_strict},
                                              {"xgt_cnet/old/fail", Verdict::fail},
                                              {"xgt_cnet/old/memory", Verdict::pass},
                                              {"xgt_cnet/old/other_model", Verdict::skip},
                                              {"xgt_cnet/old/pass", Verdict::pass},
                                              {"xgt_cnet/old/silent", Verdict::pass}}))
        << kind;
    EXPECT_EQ(file->run.endpoint, "emulator xbc-h") << kind;
    EXPECT_EQ(file->run.vectors_hash, "f46dafb82b94fcde") << kind;
    for (const results::CaseResult& result : file->results) {
      const std::string said =
          result.verdict == Verdict::fail         ? "data: expected 0001, got 0000"
          : result.verdict == Verdict::non_strict ? "allowed alternative: word = zero"
          : result.verdict == Verdict::skip       ? "for xbm-s; the profile declares xbc-h"
                                                  : "";
      EXPECT_EQ(result.message, said) << kind << ' ' << result.id;
    }
  }
}

TEST_F(ResultFileTest, EveryVerdictAndRepetitionComesBackFromOurJunit) {
  std::vector<results::CaseResult> results;
  for (Verdict verdict : text::Tally::verdicts)
    results.push_back(
        samples::with(verdict, "xgt_cnet/v/" + std::to_string(results.size()), "why: so"));
  results.push_back(results.front());
  results.back().repeat = 2;
  samples::write_results(folder_ / "r.ndjson", results);
  ASSERT_TRUE(results::replay(folder_ / "r.ndjson", *reports::junit_report(folder_ / "r.xml")));
  const Result<ResultFile> file = read_result_file(folder_ / "r.xml");
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->results.size(), results.size());
  for (std::size_t i = 0; i < results.size(); ++i) {
    EXPECT_EQ(file->results[i].id, results[i].id);
    EXPECT_EQ(file->results[i].repeat, results[i].repeat);
    EXPECT_EQ(file->results[i].verdict, results[i].verdict) << results[i].id;
    EXPECT_EQ(file->results[i].message, results[i].verdict == Verdict::pass ? "" : "why: so")
        << results::to_string(results[i].verdict);
  }
}

TEST_F(ResultFileTest, JunitOfOthersIsRead) {
  const std::string path = write(
      "o.xml", R"(<?xml version="1.0"?><testsuite name="s"><testcase classname="a.B" name="c"/>
    <testcase classname="a.B" name="c"/><testcase name="d"><failure>
      assertion: x != y
      more</failure></testcase><testcase classname="a.B" name="e #2"><skipped/></testcase></testsuite>)");
  const Result<ResultFile> file = read_result_file(path);
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_EQ(file->results.size(), 4u);
  EXPECT_EQ(file->results[0].id, "a.B/c");
  EXPECT_EQ(file->results[1].repeat, 1);
  EXPECT_EQ(file->results[2].id, "d");
  EXPECT_EQ(file->results[2].verdict, Verdict::fail);
  EXPECT_EQ(file->results[2].message, "assertion: x != y");
  EXPECT_EQ(file->results[3].id, "a.B/e #2");
  EXPECT_EQ(file->results[3].verdict, Verdict::skip);
}

TEST_F(ResultFileTest, AKilledRunLoadsWithoutItsEnd) {
  samples::write_results(folder_ / "k.ndjson", {samples::failure()}, false);
  std::ofstream(folder_ / "k.ndjson", std::ios::app) << R"({"case":{"id":"cut o)";
  const Result<ResultFile> file = read_result_file(folder_ / "k.ndjson");
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->results.size(), 1u);
  EXPECT_FALSE(file->end);
}

TEST_F(ResultFileTest, WhatCannotBeReadIsNamedWithItsPlace) {
  EXPECT_THAT(read_result_file(folder_ / "none").error().message,
              AllOf(HasSubstr("none"), HasSubstr("no such file")));
  EXPECT_FALSE(read_result_file(folder_ / "")) << "a folder";
  EXPECT_THAT(error_of("empty", " \n"), HasSubstr("it is empty"));
  EXPECT_THAT(error_of("noise", std::string("\xff\x00\x05", 3)),
              AllOf(HasSubstr("noise"), HasSubstr("line 1, column 1")));
  EXPECT_THAT(error_of("list.json", "[1]"), HasSubstr("no result of a run"));
  EXPECT_THAT(error_of("new.json", R"({"schema": 2, "run": {}, "cases": []})"),
              HasSubstr("its schema is 2, this version knows 1"));
  EXPECT_THAT(error_of("half.xml", "<testsuites>\n<testsuite>\n<testcase name=\"a\""),
              HasSubstr("half.xml, line 3"));
  EXPECT_THAT(error_of("page.xml", "<html/>"), HasSubstr("<html> instead of <testsuites>"));
  EXPECT_THAT(error_of("bare.xml", "<testsuite><testcase/></testsuite>"),
              HasSubstr("test case 1 has no name"));
  const std::string whole = samples::read_file(stored + ".json");
  EXPECT_THAT(error_of("cut.json", whole.substr(0, whole.size() / 2)),
              AllOf(HasSubstr("cut.json"), HasSubstr("line ")));
  std::string verdict = whole;
  verdict.replace(verdict.find("\"NON-STRICT\"}"), 12, "\"PERHAPS\"");
  EXPECT_THAT(error_of("verdict.json", verdict),
              AllOf(HasSubstr("verdict.json, case 1"), HasSubstr("PERHAPS")));
  const std::string lines = samples::read_file(stored + ".ndjson");
  EXPECT_THAT(error_of("lines.ndjson", lines.substr(0, lines.find('\n') + 1) + "{]\n"),
              HasSubstr("lines.ndjson, line 2"));
}

/// No prefix of a file may do worse than an error.
TEST_F(ResultFileTest, EveryTruncationIsSurvived) {
  for (const char* kind : {".ndjson", ".json", ".xml"}) {
    const std::string whole = samples::read_file(stored + kind);
    for (std::size_t size = 0; size < whole.size(); size += 211) {
      const Result<ResultFile> file = read_result_file(write("cut", whole.substr(0, size)));
      if (file) {
        EXPECT_LE(file->results.size(), 6u);
      } else {
        EXPECT_THAT(file.error().message, HasSubstr("cannot read "));
      }
    }
  }
}

TEST_F(ResultFileTest, HostileContentComesThrough) {
  results::CaseResult result = samples::failure();
  result.message = "<script>\x05\xFF&]]>";
  result.received_bytes.assign(1 << 20, 0xFF);
  samples::write_results(folder_ / "h.ndjson", {result});
  ASSERT_TRUE(results::replay(folder_ / "h.ndjson", *reports::json_report(folder_ / "h.json")));
  ASSERT_TRUE(results::replay(folder_ / "h.ndjson", *reports::junit_report(folder_ / "h.xml")));
  for (const char* kind : {"h.ndjson", "h.json", "h.xml"}) {
    const Result<ResultFile> file = read_result_file(folder_ / kind);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_THAT(file->results.at(0).message, HasSubstr("<script>")) << kind;
  }
}

}  // namespace
}  // namespace fieldproof::compare
