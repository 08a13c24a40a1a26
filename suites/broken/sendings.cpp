#include "suites/broken/sendings.hpp"

#include <algorithm>
#include <utility>

namespace fieldproof::broken {

void SendQueue::put(Sendings sendings, Time from) {
  for (Sending& sending : sendings) {
    if (sending.bytes.empty()) continue;
    const Time due = from + sending.after;
    const auto behind =
        std::upper_bound(pending_.begin(), pending_.end(), due,
                         [](Time time, const Pending& other) { return time < other.due; });
    pending_.insert(behind, {due, std::move(sending)});
  }
}

std::optional<Time> SendQueue::wake_at(std::optional<Time> other) const {
  if (pending_.empty()) return other;
  return other ? std::min(*other, pending_.front().due) : pending_.front().due;
}

Bytes SendQueue::take(Time now) {
  if (pending_.empty() || pending_.front().due > now) return {};
  Pending next = std::move(pending_.front());
  pending_.pop_front();
  const Bytes bytes = next.sending.bytes;
  if (next.sending.every > Duration::zero()) {
    next.sending.after = next.sending.every;
    put({std::move(next.sending)}, now);
  }
  return bytes;
}

}  // namespace fieldproof::broken
