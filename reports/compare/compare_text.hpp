// A comparison as the console prints it.
#pragma once

#include <cstddef>
#include <string>

#include "reports/compare/compare.hpp"

namespace fieldproof::compare {

struct CompareTextOptions {
  std::size_t limit = 50;  // lines a list; 0: all
};

/// The runs, what changed between the first and each other, reply times, and for three or more runs
/// the matrix of the cases that differ; last the outcome. Only characters that xml_text allows.
std::string compare_text(const ComparisonSet& set, const CompareTextOptions& options = {});

/// What was run: "emulator xbc-h, profile xbc-h, firmware 1.20, vectors f46d...", as far as the
/// file says.
std::string run_facts(const RunSummary& run);
/// "FAIL", "FAIL in 3 of 10", or "-" for none.
std::string verdict_text(const CaseSummary* summary);
/// "4.208 to 8.208 ms (+4.000 ms, +95 %), p 0.00041, corrected 0.012, 10 and 10 replies"
std::string shift_text(const TimeShift& shift);

}  // namespace fieldproof::compare
