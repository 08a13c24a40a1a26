// Completion of the command line: the scripts of the shells ask the tool itself.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/usage/usage.hpp"

namespace fieldproof::usage {

struct Candidate {
  std::string word;  // whole, as it would stand in the line; it goes on where it ends with / : =
  std::string description;  // for shells that show one
  bool operator==(const Candidate&) const = default;
};

/// What may stand as value of an option, or of a positional, of a command: those that begin with
/// `beginning`.
using Values = std::function<std::vector<std::string>(const Command& command, const Option& option,
                                                      const std::string& beginning)>;

/// For the last of the words behind the tool's name. None: leave it to the shell, which knows
/// files.
std::vector<Candidate> complete(const Command& tool, const std::vector<std::string>& words,
                                const Values& values);

/// A line a candidate, "word<TAB>description".
std::string to_string(const std::vector<Candidate>& candidates);

}  // namespace fieldproof::usage
