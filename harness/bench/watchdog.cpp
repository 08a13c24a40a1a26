#include "harness/bench/watchdog.hpp"

#include "harness/system/interrupt.hpp"

namespace fieldproof::bench {

Watchdog::Watchdog(Duration limit) : limit_(limit), thread_([this] { guard(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Watchdog::watch(const std::string& id) {
  const std::lock_guard lock(mutex_);
  watched_ = id;
  ++round_;
  bit_ = false;
}

bool Watchdog::done() {
  const std::lock_guard lock(mutex_);
  watched_.clear();
  return bit_;
}

/// Looks once a limit, not once a case: watching costs a case no wake-up. A case is ended between
/// one and two limits.
void Watchdog::guard() {
  std::unique_lock lock(mutex_);
  unsigned long seen = 0;
  while (!changed_.wait_for(lock, limit_, [this] { return over_; })) {
    if (!watched_.empty() && round_ == seen) {
      bit_ = true;
      os::interrupt();
    }
    seen = round_;
  }
}

}  // namespace fieldproof::bench
