// The vectors as the commands use them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "harness/vectors/loader.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof {

/// The folder or file that --vectors names; empty: the tool's own.
std::filesystem::path vectors_path(const std::string& option);

/// The vectors that --vectors names; the error tells each problem that they have.
Result<VectorSet> load_sound_vectors(const std::string& option);

std::vector<std::string> case_ids(const VectorSet& set);

ErratumInfo erratum_info(const Erratum& erratum);

}  // namespace fieldproof
