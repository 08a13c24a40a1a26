// An exchange against what the system itself takes for as many bytes.
#pragma once

#include <vector>

#include "suites/benchmark/benchmarks.hpp"
#include "suites/benchmark/example.hpp"

namespace fieldproof::suites {

/// Both in turn, so that they see the same machine; each makes so many `exchanges`. `ours` returns
/// the transcript of the example, which is judged outside of the time.
void compare(benchmark::State& state, int exchanges, auto&& bare, auto&& ours,
             const Example& example) {
  std::vector<double> bare_us, our_us;
  for (auto _ : state) {
    (void)_;
    bare_us.push_back(microseconds(bare));
    exchange::Transcript transcript;
    our_us.push_back(microseconds([&] { transcript = ours(); }));
    example.judge(transcript);
  }
  state.counters["bare_median_us"] = median(bare_us) / exchanges;
  state.counters["exchange_median_us"] = median(our_us) / exchanges;
  state.counters["ratio"] = median(our_us) / median(bare_us);
}

}  // namespace fieldproof::suites
