// Is a device still worth asking? One that floods, trickles, sends half frames or noise would take
// hours to fail every case for the same reason.
#pragma once

#include <string>

#include "harness/protocol.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

class WorthAsking {
 public:
  /// `max_restarts`: how often a device that the bench starts itself is started again, after it
  /// ended, fell mute or sent without end, in all. One that falls mute or sends without end in
  /// ordinary requests is given up sooner: where three times in a row fewer than ten cases passed
  /// in between, it would do so in all of them.
  explicit WorthAsking(int max_restarts) : max_restarts_(max_restarts) {}

  /// After a case that was executed; `set_up`: the device answered what set it up, be it by a
  /// refusal. Empty, or why the run ends here.
  std::string after(const results::CaseResult& result, const harness::Protocol& protocol,
                    bool set_up);
  /// Before the bench starts a device again that was lost in `result`; `odd`: behind what a device
  /// may not answer, or its program has ended. Empty, or why not.
  std::string restart(const results::CaseResult& result, bool odd);

 private:
  int max_restarts_;
  int restarts_ = 0, fruitless_ = 0;
  int passed_ = 0;  // since it was started
  int doubt_ = 0;   // since the last whole frame
};

}  // namespace fieldproof::bench
