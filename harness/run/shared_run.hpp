// One selection of cases on several ports at once: each case runs once, the next free port takes
// the next one.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/benches.hpp"
#include "harness/bench/watchdog.hpp"

namespace fieldproof::run {

/// What a case ended the run with: "internal error in ID: ...; please report it".
std::string internal_error(const vectors::Case& source, const std::exception& error);

class SharedRun {
 public:
  struct Port {
    std::string name;  // of the device
    bench::Benches* benches = nullptr;
    std::string unable = {};  // why it did not start; empty: it answers
  };
  struct Task {
    const vectors::Case* source = nullptr;
    int repeat = 0;
    std::optional<results::CaseResult> earlier = {};  // of a port that failed in it
    std::vector<std::size_t> only =
        {};  // the ports that could run it; empty: it makes no difference
  };
  /// Takes a result, one at a time; false: stop here.
  using OnResult = std::function<bool(const vectors::Case& source, results::CaseResult result)>;

  SharedRun(std::vector<Port> ports, std::deque<Task> tasks, OnResult on_result);

  /// Until every case has its result. A port takes the next case that it could run. What a port
  /// that vanishes leaves goes to the others; what none of those left could run is BLOCKED. The
  /// case in which a port failed is run elsewhere, but only once more: it may be the case that does
  /// it.
  void execute();

  const std::vector<std::string>& troubles() const {
    return troubles_;
  }  // "a: the port failed in ..."
  bool interrupted() const { return interrupted_; }
  /// What no port has begun, after `on_result` has stopped the run.
  const std::deque<Task>& left() const { return tasks_; }

 private:
  void serve(std::size_t port);
  bool take(std::size_t port, Task& task);
  /// False: the port is done.
  bool run(std::size_t number, const Task& task, bench::Watchdog& watchdog);
  void finish(const Task& task);
  void report(const Task& task, results::CaseResult result);
  /// What was thrown ends the run.
  void give_up(const Task& task, const std::exception& error);

  std::vector<Port> ports_;
  OnResult on_result_;
  std::mutex mutex_;                 // of all below
  std::condition_variable changed_;  // a case was finished or given back
  std::deque<Task> tasks_;
  std::size_t running_ = 0;
  std::vector<std::string> troubles_, stops_;
  bool interrupted_ = false;
  bool hung_ = false;
  bool over_ = false;  // on_result_ said so
};

}  // namespace fieldproof::run
