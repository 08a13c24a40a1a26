// What to say when a result or report file cannot be used.
#pragma once

#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::results {

/// "cannot write out/junit.xml: no space left on device; free some space". `error` is an errno.
Error file_error(std::string_view verb, const std::string& path, int error);

}  // namespace fieldproof::results
