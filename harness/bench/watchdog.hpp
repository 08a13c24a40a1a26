// Ends a case in which the bench itself hangs: no case of these protocols takes a minute between
// two results.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "src/base/time.hpp"

namespace fieldproof::bench {

class Watchdog {
 public:
  /// After `limit` the watched case's waits end as if Ctrl-C had been pressed
  /// (harness/system/interrupt.hpp).
  explicit Watchdog(Duration limit = 60s);
  ~Watchdog();

  void watch(const std::string& id);
  /// Ends the watch; did it bite?
  bool done();

 private:
  void guard();

  Duration limit_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string watched_;      // empty: nothing
  unsigned long round_ = 0;  // tells one watch from the next
  bool bit_ = false;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace fieldproof::bench
