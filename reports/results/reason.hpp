// Why a run ends with another exit code than 0.
#pragma once

#include <string>
#include <vector>

namespace fieldproof::results {

struct Reason {
  int exit_code = 1;    // that it asks for: 1, 3, 4 or 130
  std::string what;     // a word for machines: "verdicts", "min-judged", "trouble"
  std::string message;  // for people: "conformance failed: 2 FAIL"

  bool operator==(const Reason&) const = default;
};

/// Cases of the run show it themselves: they failed, or are in error.
bool is_shown_by_cases(const Reason& reason);

/// The exit code of them all, by precedence: 130 interrupted, 3 bench trouble, 1 gate not met, 4
/// nothing executed, 0 where there is none.
int exit_code_of(const std::vector<Reason>& reasons);

/// "conformance failed: 2 FAIL; not qualified: 3 not judged", the gravest first.
std::string to_string(const std::vector<Reason>& reasons);

}  // namespace fieldproof::results
