// Both ends, count and hash of bytes that nobody reads in full: else a device that floods would be
// what the reports consist of.
#pragma once

#include "reports/results/case_result.hpp"

namespace fieldproof::results {

/// Bytes of each end that are kept.
inline constexpr std::size_t extract_end = 64;

/// Of more than `most` bytes (at least both ends) the first stay. Empty: nothing was cut.
Extract cut(Bytes& bytes, std::size_t most);

/// Received in a row by the same step over the same link: where that comes to more than `most`
/// bytes, it becomes one event, from the first of them to the last, with an extract.
void cut_runs(std::vector<Event>& exchange, std::size_t most);

}  // namespace fieldproof::results
