// The wall clock, for reports.
#pragma once

#include <string>

namespace fieldproof::run {

/// Local time with its zone, as ISO 8601 writes it: "2026-01-31T12:00:00+01:00".
std::string timestamp();

}  // namespace fieldproof::run
