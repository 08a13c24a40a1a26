// Replies of one channel, in the order of their requests.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "src/base/bytes.hpp"
#include "src/base/time.hpp"

namespace fieldproof::plc {

class ReplyQueue {
 public:
  void put(Time due, Bytes bytes) { replies_.push_back({due, std::move(bytes)}); }

  /// The next reply, where it is due; else empty.
  Bytes take(Time now) {
    if (replies_.empty() || replies_.front().due > now) return {};
    Bytes bytes = std::move(replies_.front().bytes);
    replies_.pop_front();
    return bytes;
  }

  /// When the next reply is due, or `other` where that is earlier.
  std::optional<Time> wake_at(std::optional<Time> other) const {
    if (replies_.empty()) return other;
    return other ? std::min(*other, replies_.front().due) : replies_.front().due;
  }

  void clear() { replies_.clear(); }

 private:
  struct Pending {
    Time due{};
    Bytes bytes;
  };
  std::deque<Pending> replies_;
};

}  // namespace fieldproof::plc
