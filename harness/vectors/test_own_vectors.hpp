// The vectors of this project, for tests that run some of them.
#pragma once

#include <map>
#include <string>

#include "harness/vectors/loader.hpp"

namespace fieldproof::vectors::test {

/// Those that match the filter, read once a program. Not for two threads at once.
inline const VectorSet& own_vectors(const harness::Protocols& protocols,
                                    const std::string& filter) {
  static std::map<std::string, VectorSet> read;
  const auto known = read.find(filter);
  if (known != read.end()) return known->second;
  return read.emplace(filter, load_vectors(FIELDPROOF_SOURCE_DIR "/vectors", {protocols, filter}))
      .first->second;
}

}  // namespace fieldproof::vectors::test
