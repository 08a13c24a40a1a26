// Which option would let a run judge more.
#pragma once

#include <string>
#include <vector>

#include "harness/bench/benches.hpp"

namespace fieldproof::run {

/// "with --allow-write M0-M199: 250 more": the one option with which most of the cases that were
/// BLOCKED could run on this device, and of several that let nearly as many run the one that
/// permits least. Empty where none helps. Nothing is sent.
std::string coverage_hint(const bench::Benches& port, const bench::BenchOptions& options,
                          const harness::Protocols& known,
                          const std::vector<const vectors::Case*>& blocked);

}  // namespace fieldproof::run
