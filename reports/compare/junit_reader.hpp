// JUnit back into results: our own with all that it keeps, that of others as far as it goes.
#pragma once

#include <string>

#include "reports/compare/result_file.hpp"

namespace fieldproof::compare {

/// Failure is FAIL, error ERROR, skipped SKIP, anything else PASS, unless the file is ours and
/// names the verdict. There are no reply times, no frames, and `rev` is 0: unknown. Errors name
/// `path` and the line.
Result<ResultFile> read_junit_text(const std::string& text, const std::string& path);

}  // namespace fieldproof::compare
