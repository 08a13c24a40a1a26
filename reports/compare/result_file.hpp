// The results of a run, whatever wrote them: NDJSON or JSON of this tool, or JUnit of any.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "src/base/result.hpp"

namespace fieldproof::compare {

struct ResultFile {
  std::string path;
  results::RunInfo run;
  std::optional<results::RunEnd> end;  // nothing: the run was killed, or the file does not say
  std::vector<results::CaseResult> results;  // in the order of the file
};

/// Tells the kinds apart by their content. Errors name the file and the place (line, or case).
Result<ResultFile> read_result_file(const std::string& path);

}  // namespace fieldproof::compare
