#include "harness/vectors/in_threads.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace fieldproof::vectors {

void in_threads(std::size_t count, const std::function<void(std::size_t)>& act) {
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) act(i);
  };
  const std::size_t processors = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> others;  // this thread works, too
  while (others.size() + 1 < std::min(processors, count)) others.emplace_back(work);
  work();
}

}  // namespace fieldproof::vectors
