#include "harness/run/run_ahead.hpp"

#include <exception>

namespace fieldproof::run {

namespace {

constexpr std::size_t batch_size = 16;
constexpr std::size_t batches_a_thread = 4;  // begun or waiting: enough that none runs dry

}  // namespace

RunAhead::RunAhead(std::vector<Runner> runners) {
  for (Runner& run : runners) threads_.emplace_back([this, run = std::move(run)] { serve(run); });
}

RunAhead::~RunAhead() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  work_.notify_all();
}

bool RunAhead::ask(const vectors::Case& source, int round, const Take& take) {
  gathering_.push_back({&source, round});
  if (gathering_.size() < batch_size) return true;
  send_off();
  return deliver(batches_a_thread * threads_.size(), take);
}

bool RunAhead::finish(const Take& take) {
  if (!gathering_.empty()) send_off();
  return deliver(0, take);
}

void RunAhead::send_off() {
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(&under_way_.emplace_back(Batch{std::move(gathering_)}));
  }
  gathering_.clear();
  work_.notify_one();
}

/// What is done, the oldest first; waits for it as long as more than so many are under way.
bool RunAhead::deliver(std::size_t most_under_way, const Take& take) {
  for (;;) {
    std::vector<Outcome> ready;
    {
      std::unique_lock lock(mutex_);
      if (under_way_.empty()) return true;
      if (under_way_.size() > most_under_way)
        finished_.wait(lock, [this] { return under_way_.front().done; });
      if (!under_way_.front().done) return true;
      ready = std::move(under_way_.front().cases);
      under_way_.pop_front();
    }
    for (Outcome& outcome : ready)
      if (!take(std::move(outcome))) return false;
  }
}

RunAhead::Batch* RunAhead::next() {
  std::unique_lock lock(mutex_);
  work_.wait(lock, [this] { return over_ || !waiting_.empty(); });
  if (over_) return nullptr;
  Batch* const batch = waiting_.front();
  waiting_.pop_front();
  return batch;
}

void RunAhead::serve(const Runner& run) {
  while (Batch* const batch = next()) {
    for (Outcome& outcome : batch->cases) {
      if (over_) return;
      try {
        outcome.result = run(*outcome.source);
      } catch (const std::exception&) {
        // Who takes it meets the same, and says so.
      }
    }
    {
      const std::lock_guard lock(mutex_);
      batch->done = true;
    }
    finished_.notify_one();
  }
}

}  // namespace fieldproof::run
