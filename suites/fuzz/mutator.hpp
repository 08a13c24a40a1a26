// Inputs that are nearly right: good ones with a few changes. The same seed and number give the
// same input everywhere.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "src/base/bytes.hpp"

namespace fieldproof::fuzz {

class Mutator {
 public:
  /// `seeds` may be empty: then inputs are random.
  Mutator(std::vector<Bytes> seeds, std::uint64_t seed) : seeds_(std::move(seeds)), seed_(seed) {}

  /// `number` counts from 0.
  Bytes input(std::uint64_t number) const;

 private:
  using Random = std::mt19937_64;
  Bytes beginning(Random& random) const;
  void change(Bytes& bytes, Random& random) const;

  std::vector<Bytes> seeds_;
  std::uint64_t seed_;
};

}  // namespace fieldproof::fuzz
