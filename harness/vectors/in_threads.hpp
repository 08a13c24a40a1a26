// Work of many equal parts, which do not meet, on all processors.
#pragma once

#include <cstddef>
#include <functional>

namespace fieldproof::vectors {

/// `act` for each of 0 to count - 1, in any order, at the same time; it must not throw. Returns
/// when all are done.
void in_threads(std::size_t count, const std::function<void(std::size_t)>& act);

}  // namespace fieldproof::vectors
