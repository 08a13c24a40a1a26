// What a broken device sends, and when: shared by the broken devices of all protocols.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/base/time.hpp"

namespace fieldproof::broken {

/// Bytes that go out `after` the request. With `every`, again and again.
struct Sending {
  Bytes bytes;
  Duration after{};
  Duration every{};
};
using Sendings = std::vector<Sending>;

/// Sendings in the order of time.
class SendQueue {
 public:
  /// Empty ones are passed over.
  void put(Sendings sendings, Time from);
  /// When the first is due, or `other`, whichever is first.
  std::optional<Time> wake_at(std::optional<Time> other) const;
  /// The first when it is due, else nothing.
  Bytes take(Time now);
  void clear() { pending_.clear(); }

 private:
  struct Pending {
    Time due{};
    Sending sending;
  };
  std::deque<Pending> pending_;
};

}  // namespace fieldproof::broken
