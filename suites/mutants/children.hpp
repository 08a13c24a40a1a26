// Work that may crash or never end, each piece of it in a process of its own.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::mutants {

struct Ended {
  enum class How { returned, crashed, hung };
  How how = How::crashed;
  int value = 0;  // that it returned, or noted last
};

/// What a piece of work may do besides: each step of it has so much processor time.
class Steps {
 public:
  Steps(int& noted, double seconds) : noted_(noted), seconds_(seconds) {}
  /// The time counts anew; `value` is what is known so far.
  void next(int value);

 private:
  int& noted_;
  double seconds_;
};

struct Effort {
  unsigned jobs = 1;       // at a time
  double seconds = 1;      // of processor time a step
  std::size_t memory = 0;  // bytes that a process may have; 0: any
};

/// work(0) to work(count - 1). `begin` is called here before each, `end` after it.
std::vector<Ended> in_children(std::size_t count, const Effort& effort,
                               const std::function<int(std::size_t, Steps&)>& work,
                               const std::function<void(std::size_t)>& begin = {},
                               const std::function<void(std::size_t, const Ended&)>& end = {});

}  // namespace fieldproof::mutants
