// The benchmarks of fieldproof_bench, by what they measure.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace fieldproof::suites {

/// What stands behind a benchmark's name (empty, or "/before" and "/after"), and the tool's path.
using Tools = std::vector<std::pair<std::string, std::string>>;

/// Each adds its benchmarks; `brief`: with hardly a repetition.
void register_tool_runs(const Tools& tools, bool brief);
void register_exchanges(bool brief);
/// `tool` serves the device that is asked over loopback.
void register_network(const std::string& tool, bool brief);
void register_simulated(bool brief);

/// Once by itself, once on all processors together, as a run has its cases on simulated time.
inline void on_each_processor(benchmark::internal::Benchmark* benchmark) {
  benchmark->UseRealTime()->Threads(1)->ThreadPerCpu();
}

/// Reorders `samples`, of which there is at least one.
inline double median(std::vector<double>& samples) {
  const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
  std::ranges::nth_element(samples, middle);
  return *middle;
}

/// How long `work` takes, in microseconds.
double microseconds(auto&& work) {
  const auto started = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - started)
      .count();
}

}  // namespace fieldproof::suites
