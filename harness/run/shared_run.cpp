#include "harness/run/shared_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <chrono>
#include <thread>

#include "harness/judge/judge.hpp"
#include "harness/system/interrupt.hpp"

namespace fieldproof::run {

std::string internal_error(const vectors::Case& source, const std::exception& error) {
  return fmt::format("internal error in {}: {}; please report it", source.id, error.what());
}

SharedRun::SharedRun(std::vector<Port> ports, std::deque<Task> tasks, OnResult on_result)
    : ports_(std::move(ports)), on_result_(std::move(on_result)), tasks_(std::move(tasks)) {}

void SharedRun::execute() {
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < ports_.size(); ++i) threads.emplace_back([this, i] { serve(i); });
  }
  interrupted_ = interrupted_ && !hung_;  // the watchdog ends a hanging case in the way of Ctrl-C
  if (interrupted_ || hung_) return;
  for (Task task; !over_ && !tasks_.empty();) try {
      task = std::move(tasks_.front());
      tasks_.pop_front();
      ++running_;
      finish(task);
    } catch (const std::exception& error) {
      return give_up(task, error);
    }
}

/// No port is left that could run it.
void SharedRun::finish(const Task& task) {
  if (task.earlier) return report({task.source, task.repeat}, *task.earlier);
  results::CaseResult result = judging::result_of(*task.source);
  result.verdict = results::Verdict::blocked;
  std::vector<std::string> names;
  for (const std::size_t port : task.only) names.push_back(ports_[port].name);
  result.message =
      fmt::format("{}: {}",
                  names.empty() ? "no port is left"
                                : fmt::format("only {} could run it", fmt::join(names, ", ")),
                  fmt::join(stops_, "; "));
  report(task, std::move(result));
}

void SharedRun::give_up(const Task& task, const std::exception& error) {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
    troubles_.push_back(internal_error(*task.source, error));
    --running_;
  }
  changed_.notify_all();
}

void SharedRun::serve(std::size_t number) {
  const Port& port = ports_[number];
  const auto cannot = [&](const std::string& when, const Error& error) {
    const std::lock_guard lock(mutex_);
    interrupted_ |= error.interrupted;
    stops_.push_back(port.name + ": " + when + error.message);
    if (!error.interrupted) troubles_.push_back(stops_.back());
  };
  if (!port.unable.empty()) return cannot("", Error{port.unable});
  bench::Watchdog watchdog;
  for (Task task; take(number, task);) try {
      if (!run(number, task, watchdog)) return;
    } catch (const std::exception& error) {
      return give_up(task, error);
    }
  if (fieldproof::os::interrupted()) return;
  if (const Status still = port.benches->start(); !still)
    cannot("after the last case: ", still.error());
}

/// Waits while another port may still give its case back.
bool SharedRun::take(std::size_t port, Task& task) {
  const auto mine = [&] {
    return std::ranges::find_if(tasks_, [&](const Task& one) {
      return one.only.empty() || std::ranges::find(one.only, port) != one.only.end();
    });
  };
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return over_ || mine() != tasks_.end() || running_ == 0; });
  const auto next = mine();
  if (over_ || next == tasks_.end()) return false;
  task = std::move(*next);
  tasks_.erase(next);
  ++running_;
  return true;
}

bool SharedRun::run(std::size_t number, const Task& task, bench::Watchdog& watchdog) {
  const Port& port = ports_[number];
  watchdog.watch(task.source->id);
  const auto started = std::chrono::steady_clock::now();
  results::CaseResult result = port.benches->run(*task.source);
  result.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  result.dut = port.name;
  const bool hung = watchdog.done();
  const bool ended = fieldproof::os::interrupted() && !hung;
  const bool failed = !ended && (hung || port.benches->port_failed());
  const bool lost = failed && !hung && !task.earlier;
  const bool done = ended || hung || !port.benches->stopped().empty();
  if (hung)
    result.message = "the bench hung in this case for more than a minute; " + result.message;
  {
    const std::lock_guard lock(mutex_);
    hung_ |= hung;
    interrupted_ |= ended;
    over_ |= hung || ended;
    if (done)
      stops_.push_back(port.name + ": " +
                       (hung ? "hung in " + result.id : port.benches->stopped()));
    if (done && !ended) troubles_.push_back(stops_.back());
    if (lost) tasks_.push_front({task.source, task.repeat, std::move(result), task.only});
    if (ended || lost) --running_;
  }
  changed_.notify_all();
  if (ended || lost) return false;  // not finished here: the case has no result of this port
  report(task, std::move(result));
  return !done;
}

void SharedRun::report(const Task& task, results::CaseResult result) {
  result.repeat = task.repeat;
  if (task.earlier)
    result.notes.push_back(fmt::format("begun on {}, whose port failed", task.earlier->dut));
  {
    const std::lock_guard lock(mutex_);
    over_ |= !on_result_(*task.source, std::move(result));
    --running_;
  }
  changed_.notify_all();
}

}  // namespace fieldproof::run
