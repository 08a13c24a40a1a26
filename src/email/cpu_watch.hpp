// The event information of the e-mail settings (FEnet EN 7.4.1; DECISIONS.md email/cpu-events): the
// CPU is looked at every so often, counted from power-on, and what has changed since the look
// before is an event. A change that is undone in between is none.
#pragma once

#include <optional>
#include <vector>

#include "src/email/settings.hpp"

namespace fieldproof::email {

class CpuWatch {
 public:
  struct State {
    bool run = true, error = false;
  };

  explicit CpuWatch(Duration period) : period_(period) {}

  /// Power is on, or on again.
  void begin(Time now, State state) {
    next_ = now + period_;
    seen_ = state;
  }
  Time next() const { return next_; }
  /// What a look at `now` finds; nothing before its time.
  std::vector<CpuEvent> look(Time now, State state) {
    std::vector<CpuEvent> events;
    if (now < next_) return events;
    next_ += period_ * ((now - next_) / period_ + 1);
    if (seen_.run != state.run)
      events.push_back(state.run ? CpuEvent::stop_to_run : CpuEvent::run_to_stop);
    if (state.error && !seen_.error) events.push_back(CpuEvent::error);
    seen_ = state;
    return events;
  }

 private:
  Duration period_;
  Time next_{};
  State seen_{};
};

}  // namespace fieldproof::email
