// Cases on simulated time do not meet one another: several threads run them, ahead of the one that
// takes their results in their order.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "harness/vectors/case.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::run {

class RunAhead {
 public:
  /// What a thread makes of a case; nothing: who takes it has to run it. Used by one thread.
  using Runner = std::function<std::optional<results::CaseResult>(const vectors::Case& source)>;
  struct Outcome {
    const vectors::Case* source = nullptr;
    int round = 0;
    std::optional<results::CaseResult> result = {};  // nothing: see Runner, or it has thrown
  };
  /// Takes an outcome; false: nothing more is wanted.
  using Take = std::function<bool(Outcome outcome)>;

  /// A thread for each of `runners`, at least one.
  explicit RunAhead(std::vector<Runner> runners);
  ~RunAhead();  // what was asked and not taken is dropped
  RunAhead(const RunAhead&) = delete;

  /// Asks for a case, which outlives this, and gives what is ready to `take`, in the order in which
  /// it was asked. Waits where much is under way, so that memory stays bounded. False: `take` was.
  bool ask(const vectors::Case& source, int round, const Take& take);
  /// Waits for all that was asked, and gives it to `take`.
  bool finish(const Take& take);

 private:
  /// Cases that one thread runs: to hand over each alone would cost more than many a case.
  struct Batch {
    std::vector<Outcome> cases;
    bool done = false;
  };

  void send_off();
  bool deliver(std::size_t most_under_way, const Take& take);
  Batch* next();
  void serve(const Runner& run);

  std::vector<Outcome> gathering_;  // not yet a batch; of the thread that asks
  std::mutex mutex_;                // of all below
  std::condition_variable work_, finished_;
  std::deque<Batch> under_way_;  // in order
  std::deque<Batch*> waiting_;   // those that no thread has begun
  std::atomic<bool> over_{false};
  std::vector<std::jthread> threads_;
};

}  // namespace fieldproof::run
