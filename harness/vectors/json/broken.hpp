// How the reader of vectors speaks of what it cannot read.
#pragma once

#include <stdexcept>

namespace fieldproof::vectors {

/// Thrown inside the reader; becomes one of VectorSet::problems.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace fieldproof::vectors
