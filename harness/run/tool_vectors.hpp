// The vectors as the commands use them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/bench/files/profile.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::run {

/// The folder or file that --vectors names; empty: the tool's own.
std::filesystem::path vectors_path(const std::string& option);

/// The vectors that --vectors names; of cases only those that `filter` selects (empty: all). The
/// error tells each problem that they have.
Result<vectors::VectorSet> load_sound_vectors(const std::string& option,
                                              const harness::Protocols& protocols,
                                              const std::string& filter = {});

/// Gives the cases the sentences of the decisions that they cite: those of DECISIONS.md in
/// `from` (the folder, or beside the one file, of the vectors), and of the tool's own.
void add_decisions(const std::filesystem::path& from, vectors::VectorSet& set);

/// The decisions that a profile names are there; the error names the profile.
Status check_decisions(const bench::Profile& profile, const vectors::VectorSet& set);

/// vectors::meant_filter over all of their cases.
std::string meant_filter(const std::string& option, const harness::Protocols& protocols,
                         const std::string& filter);

std::vector<std::string> case_ids(const vectors::VectorSet& set);

/// `met`: the vectors whose cases were made by what is right.
results::ErratumInfo erratum_info(const vectors::Erratum& erratum,
                                  std::vector<std::string> met = {});

}  // namespace fieldproof::run
