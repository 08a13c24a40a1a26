#include "harness/exchange/pending.hpp"

#include <algorithm>

namespace fieldproof::exchange {

using results::Event;

namespace {

std::ptrdiff_t distance(std::size_t count) { return static_cast<std::ptrdiff_t>(count); }

}  // namespace

void Pending::add(EventAt event) {
  events_.push_back(event);
  bytes_.insert(bytes_.end(), event->bytes.begin(), event->bytes.end());
}

Pending::EventAt Pending::pop() {
  const EventAt event = events_.front();
  events_.pop_front();
  bytes_.erase(bytes_.begin(), bytes_.begin() + distance(event->bytes.size()));
  return event;
}

/// What is cut off came no later than the whole ended.
Pending::EventAt Pending::pop(std::size_t count, Transcript& transcript) {
  const EventAt first = events_.front();
  if (first->bytes.size() <= count) return pop();
  Event rest = *first;
  rest.start = rest.end;
  rest.bytes.erase(rest.bytes.begin(), rest.bytes.begin() + distance(count));
  first->bytes.resize(count);
  events_.front() = transcript.events.insert(std::next(first), std::move(rest));
  events_.push_front(first);
  return pop();
}

Time Pending::give(std::size_t count, int step, Transcript& transcript) {
  Time last{};
  while (count > 0 && !events_.empty()) {
    const EventAt event = pop(count, transcript);
    event->step = step;
    count -= event->bytes.size();
    last = event->end;
  }
  return last;
}

Time Pending::give_front(int step) {
  const EventAt event = pop();
  event->step = step;
  return event->end;
}

void Pending::drop() {
  events_.clear();
  bytes_.clear();
}

void Pending::leave_over(std::size_t count, Transcript& transcript) {
  while (count > 0 && !events_.empty()) {
    const EventAt event = pop(count, transcript);
    event->surplus = true;
    count -= event->bytes.size();
  }
}

void Pending::leave_over() {
  while (!events_.empty()) pop()->surplus = true;
}

}  // namespace fieldproof::exchange
