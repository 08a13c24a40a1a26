// GoogleTest as the runner: each selected case is registered as a test, so that shuffle, seed,
// sharding and IDEs work. Its own XML and exit code are not ours: GoogleTest deletes control bytes
// and can report green for tests that never ran.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/vectors/case.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

struct RunnerOptions {
  int repeat = 1;  // -1: until `run` stops it
  bool shuffle = false;
  int seed = 0;
  std::vector<std::string> gtest_arguments;  // what the user gave as --gtest_...
};

/// Runs one case, by its index and repetition; false: stop here, the rest is not run.
using RunCase = std::function<bool(const vectors::Case& source, int repeat)>;

/// Registers the cases and runs them. Returns how many were handed to `run`; a shard may get none.
std::size_t run_with_gtest(const std::vector<const vectors::Case*>& cases,
                           const RunnerOptions& options, const RunCase& run);

}  // namespace fieldproof::bench
