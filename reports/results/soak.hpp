// What a soak came to: cases repeated for hours, kept as counts and figures. The lines of the
// NDJSON file:
//   {"sample":{...}}  now and then, about the time since the sample before
//   {"soak":{...}}    at the end, about all of it
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "reports/results/response_times.hpp"

namespace fieldproof::results {

/// A stretch of a soak.
struct SoakSample {
  double from_s = 0, to_s = 0;           // since the start of the run
  std::uint64_t judged = 0, failed = 0;  // repetitions
  ResponseFigures response = {};
};

struct SoakCase {
  std::map<std::string, std::uint64_t> counts = {};  // by verdict
  ResponseFigures response = {};
};

struct SoakSummary {
  double seconds = 0, planned_s = 0;
  std::uint64_t rounds = 0;              // of the whole selection, the last one perhaps in part
  std::uint64_t judged = 0, failed = 0;  // repetitions that were executed; that turn the gate red
  ResponseFigures response = {};
  SoakSample first, last;       // the first and the last tenth of the time: drift
  std::uint64_t unwritten = 0;  // failures beyond those that stand in the file in full
  std::map<std::string, SoakCase> cases = {};

  double error_rate() const {
    return judged == 0 ? 0 : static_cast<double>(failed) / static_cast<double>(judged);
  }
};

/// Lines for people: rounds, error rate, response times, drift, failures that are not written.
std::string soak_text(const SoakSummary& soak);
/// What is known of a soak that was killed: "600 s of soak: 1200 judged repetitions, 3 red;
/// median 2.1 ms at first, 2.3 ms at last".
std::string killed_soak_text(const std::vector<SoakSample>& samples);

}  // namespace fieldproof::results
