// The mutants, as suites/mutants/generate.py has listed them, and those of them that were looked at
// and found to do what the healthy device does.
#pragma once

#include <string>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::mutants {

struct Mutant {
  int id = 0;            // 1 is the first
  std::string protocol;  // as people call it: "XGT Cnet"
  std::string file;      // "src/xgt_cnet/server.cpp"
  int line = 0, column = 0;
  std::string function, rule, before, after;
  bool once = false;       // it lies in a table that a program sets up once
  std::string equivalent;  // why no device can be told from a healthy one by it; empty: it can, or
                           // nobody has looked
};

/// Errors name the file.
Result<std::vector<Mutant>> load_table(const std::string& file);

/// Marks what `file` (equivalent.json) says. The error lists the entries that fit no mutant any more.
Status load_equivalent(const std::string& file, std::vector<Mutant>& mutants);

}  // namespace fieldproof::mutants
