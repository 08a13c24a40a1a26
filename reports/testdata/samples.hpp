// Results for the tests of the reports, and files of them.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "reports/results/ndjson.hpp"
#include "reports/results/whole_file.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::samples {

/// A FAIL with every field filled: a wrong BCC on a read of one word.
inline results::CaseResult failure() {
  results::CaseResult result;
  result.id = "xgt_cnet/rss/one_word";
  result.protocol = "xgt-cnet";
  result.title = "Read one word from M100 of station 1";
  result.level = "must";
  result.basis = "printed rule";
  result.manual = "xgb-cnet-en-1.6";
  result.section = "7.1.5 (1)(e)";
  result.quote = "BCC is the low byte of the sum from ENQ to EOT";
  result.verdict = results::Verdict::fail;
  result.message = "BCC: expected 0F, received 09 (the sum leaves out the header)";
  result.notes = {"addresses moved: %MW100 -> %MW300"};
  result.expected = "[ACK st 'rSS' '01' '02' '1234' ETX BCC]";
  result.expected_hex = "06 30 31 72 53 53 30 31 30 32 31 32 33 34 03 30 46";
  result.expected_bytes = *from_hex(result.expected_hex);
  result.received = "ACK '01rSS01021234' ETX '09'";
  result.received_bytes = *from_hex("06 30 31 72 53 53 30 31 30 32 31 32 33 34 03 30 39");
  result.differences = {{"BCC", "0F", "09", "the sum leaves out the header"}};
  const Bytes request = *from_hex("05 30 31 72 53 53 30 31 30 36 25 4D 57 31 30 30 04 41 33");
  result.exchange = {
      {results::Event::Kind::sent, 2s, 2s + 19792us, request, "ENQ '01rSS0106%MW100' EOT 'A3'"},
      {results::Event::Kind::received, 2s + 24ms, 2s + 41708us, result.received_bytes,
       result.received},
      {results::Event::Kind::note, 2s + 41708us, 2s + 41708us, {}, "silence until here"}};
  result.response_ms = {4.208};
  result.seconds = 0.0125;
  result.replay = "fieldproof run --filter xgt_cnet/rss/one_word --endpoint emulator:xbc-h";
  return result;
}

inline results::CaseResult with(results::Verdict verdict, const std::string& id,
                                const std::string& message = "") {
  results::CaseResult result;
  result.id = id;
  result.protocol = "xgt-cnet";
  result.verdict = verdict;
  result.message = message;
  return result;
}

inline results::RunInfo run_info() {
  return {"0.1.0",
          "2026-11-21T12:39:03+00:00",
          "emulator:xbc-h?station=1",
          "xbc-h",
          "fieldproof run",
          "a1b2",
          {{"gate", "default"}, {"line", "9600-8N1"}, {"seed", "7"}}};
}

inline results::RunEnd run_end(int exit_code = 1) {
  return {"2026-11-21T12:39:05+00:00", 2.25, exit_code, false, ""};
}

/// A new folder of the running test, removed with the object.
class Folder {
 public:
  Folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string(test->test_suite_name()) + "." + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(path_)) ++count;
    return count;
  }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::string& path) {
  const Result<std::string> text = results::read_whole_file(path);
  return text ? *text : "";
}

/// Of a run judged by `gate`.
inline results::RunInfo run_info(const results::Gate& gate) {
  results::RunInfo run = run_info();
  run.properties["gate"] = text::to_string(gate);
  return run;
}

/// What a run hands to its sinks.
inline void hand_over(results::Sink& sink, const results::RunInfo& run,
                      const std::vector<results::CaseResult>& results,
                      const std::optional<results::RunEnd>& end) {
  const auto expect_ok = [](const Status& done) { ASSERT_TRUE(done) << done.error().message; };
  expect_ok(sink.begin(run));
  for (const results::CaseResult& result : results) expect_ok(sink.add(results::Delivery(result)));
  results::RunLog log;
  log.run = run;
  log.end = end;
  log.results = results.size();
  expect_ok(sink.end(log));
}

/// A file of results as a run leaves it; without `end` as a killed run does.
inline void write_results(const std::string& path, const std::vector<results::CaseResult>& results,
                          bool end = true, const results::Gate& gate = {}) {
  auto writer = results::NdjsonWriter::create(path);
  ASSERT_TRUE(writer) << writer.error().message;
  hand_over(*writer, run_info(gate), results, end ? std::optional(run_end()) : std::nullopt);
}

}  // namespace fieldproof::samples
