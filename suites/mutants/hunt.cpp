#include "suites/mutants/hunt.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

namespace fieldproof::mutants {

namespace {

/// What killed other mutants lately kills the next of the same file, too.
class Killers {
 public:
  void put_first(std::vector<std::size_t>& trials) const {
    auto to = trials.begin();
    for (const std::size_t one : recent_)
      if (const auto found = std::find(to, trials.end(), one); found != trials.end()) {
        std::rotate(to, found, found + 1);
        ++to;
      }
  }
  void add(std::size_t trial) {
    std::erase(recent_, trial);
    recent_.push_front(trial);
    if (recent_.size() > most) recent_.pop_back();
  }

 private:
  static constexpr std::size_t most = 16;
  std::deque<std::size_t> recent_;
};

/// The number of the trial that is red, counted from 1; 0: none. A step that does not end is noted
/// as its negative.
int first_red(const MutatedDevices& devices, const std::vector<Trial>& trials,
              const std::vector<std::size_t>& order, Steps& steps) {
  for (const std::size_t one : order) {
    const int number = static_cast<int>(one) + 1;
    steps.next(-number);
    if (trials[one].red(devices)) return number;
  }
  return 0;
}

/// The devices of a child that becomes this mutant.
MutatedDevices devices_of(const Mutant& mutant, bool once, const HuntOptions& options,
                          std::vector<unsigned char>& reached) {
  become(mutant.id, reached.data());
  if (!once) return *options.devices;
  Result<MutatedDevices> fresh = options.fresh();
  if (!fresh) std::abort();
  return *fresh;
}

Fate fate_of(const Ended& ended) {
  switch (ended.how) {
    case Ended::How::crashed: return Fate::crashed;
    case Ended::How::hung: return Fate::hung;
    case Ended::How::returned: return ended.value ? Fate::red : Fate::survived;
  }
  return Fate::survived;
}

}  // namespace

std::string_view to_string(Fate fate) {
  switch (fate) {
    case Fate::unreached: return "unreached";
    case Fate::survived: return "survived";
    case Fate::red: return "red";
    case Fate::crashed: return "crashed";
    case Fate::hung: return "hung";
  }
  return "";
}

Status hunt(const Stage& stage, const std::vector<Mutant>& mutants, const HuntOptions& options,
            std::vector<Outcome>& outcomes) {
  const Coverage coverage(*options.devices, options.numbers, stage.trials, mutants);
  if (coverage.red() == stage.trials.size() && !stage.trials.empty())
    return fail(stage.name + ": every trial is red on the healthy device");
  fmt::print("{}: {} trials, {} of them red on the healthy device\n", stage.name,
             stage.trials.size(), coverage.red());

  std::vector<std::size_t> todo;
  for (std::size_t i = 0; i < mutants.size(); ++i)
    if (!is_killed(outcomes[i].fate) && !coverage.showing(mutants[i]).empty()) todo.push_back(i);
  Killers killers;
  std::vector<std::size_t> order;
  const auto begin = [&](std::size_t i) {
    order = coverage.showing(mutants[todo[i]]);
    Outcome& outcome = outcomes[todo[i]];
    if (outcome.section.empty()) outcome.section = stage.trials[order.front()].section;
    killers.put_first(order);
  };
  const auto work = [&](std::size_t i, Steps& steps) {
    std::vector<unsigned char> reached(options.numbers + 1);
    const Mutant& mutant = mutants[todo[i]];
    const MutatedDevices devices = devices_of(mutant, coverage.is_once(mutant), options, reached);
    return first_red(devices, stage.trials, order, steps);
  };
  const auto end = [&](std::size_t i, const Ended& ended) {
    Outcome& outcome = outcomes[todo[i]];
    outcome.fate = fate_of(ended);
    if (options.progress) options.progress(i + 1, todo.size());
    if (!is_killed(outcome.fate)) return;
    outcome.stage = stage.name;
    if (ended.value == 0) return;  // it did not come so far as to try anything
    const std::size_t by = static_cast<std::size_t>(std::abs(ended.value)) - 1;
    outcome.by = stage.trials[by].name;
    if (outcome.fate == Fate::red) killers.add(by);
  };
  in_children(todo.size(), options.effort, work, begin, end);
  return ok();
}

}  // namespace fieldproof::mutants
