// Several runs as one: the shards of a selection, done at once on several machines.
#pragma once

#include <string>
#include <vector>

#include "reports/compare/result_file.hpp"

namespace fieldproof::compare {

/// The run that the files add up to, and what is amiss with it.
struct MergedRun {
  results::RunInfo run;
  std::vector<results::CaseResult> results;  // each once, in the order of the files
  std::vector<std::string> troubles;  // a shard is missing, was killed, or had trouble of its own:
                                      // the merged run is not whole
  bool interrupted = false;           // one of them was
  std::string worse;                  // than which baseline one of them was
  double seconds = 0;                 // of the longest
};

/// Errors name the two files and what differs: vectors, tool, profile, gate, files hashed for a
/// qualification, selection, shards, or the verdict of a case that both have. Equal results of one
/// case count once.
Result<MergedRun> merge_results(const std::vector<ResultFile>& files);

}  // namespace fieldproof::compare
