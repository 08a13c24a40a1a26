#include "harness/run/case_length.hpp"

namespace fieldproof::run {

using vectors::Step;

Duration least_length(const vectors::Case& source, Duration response_max) {
  Duration length{};
  for (const Step& step : source.steps) {
    Duration one{};
    if (step.kind == Step::Kind::wait) one = step.duration;
    if (step.kind == Step::Kind::silence) one = response_max;
    if (step.every) one = *step.every;
    length += one * step.times;
  }
  return length;
}

}  // namespace fieldproof::run
