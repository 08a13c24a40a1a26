// Runs for the tests of the history.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "reports/history/history.hpp"
#include "reports/testdata/samples.hpp"

namespace fieldproof::history::test {

using results::CaseResult;
using results::Verdict;

inline CaseResult result_of(const std::string& id, Verdict verdict, std::vector<double> ms = {},
                            const std::string& message = "") {
  CaseResult result = samples::with(verdict, "xgt_cnet/" + id, message);
  result.title = "Title of " + id;
  result.manual = "xgb-cnet-en-1.6";
  result.section = "7.1.5";
  result.response_ms = std::move(ms);
  return result;
}

/// What differs between the runs of a test.
struct Head {
  std::string firmware = "V1.40";
  int day = 1;
  std::string serial = "7", vectors = "a1b2";
};

inline compare::ResultFile file_of(const Head& head, std::vector<CaseResult> results) {
  compare::ResultFile file{"results.ndjson", samples::run_info(), samples::run_end(0),
                           std::move(results)};
  file.run.started = fmt::format("2026-{:02}-{:02}T12:00:00+00:00", 1 + (head.day - 1) / 28,
                                 1 + (head.day - 1) % 28);
  file.run.vectors_hash = head.vectors;
  file.run.properties["protocol"] = "xgt-cnet";
  file.run.identity.maker = "LS";
  file.run.identity.model = "XBC";
  file.run.identity.serial = head.serial;
  file.run.identity.firmware = head.firmware;
  return file;
}

inline compare::RunSummary run_of(const Head& head, std::vector<CaseResult> results) {
  return compare::summarize(file_of(head, std::move(results)));
}

inline History open_or_fail(const std::string& path, Use use = Use::write) {
  Result<History> history = History::open(path, use);
  if (!history) throw std::runtime_error(history.error().message);
  return std::move(*history);
}

inline std::int64_t add_or_fail(History& history, const compare::RunSummary& run) {
  const Result<History::Added> added = history.add(run);
  EXPECT_TRUE(added) << (added ? "" : added.error().message);
  return added ? added->number : 0;
}

}  // namespace fieldproof::history::test
