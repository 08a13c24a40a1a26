// What came on a link and no step has taken yet.
#pragma once

#include <deque>

#include "harness/exchange/transcript.hpp"

namespace fieldproof::exchange {

/// Refers to events of one transcript; taking bytes marks them there. An event of which only a part
/// is taken becomes two.
class Pending {
 public:
  using EventAt = Transcript::Events::iterator;

  void add(EventAt event);
  bool empty() const { return events_.empty(); }
  /// All of it, whatever it came in.
  const Bytes& bytes() const { return bytes_; }
  /// The first that came: a datagram, where the link has such.
  ByteView front() const { return events_.front()->bytes; }
  /// When the last of it came.
  Time last() const { return events_.back()->end; }
  const std::deque<EventAt>& events() const { return events_; }

  /// The first `count` bytes are the step's. When the last of them came.
  Time give(std::size_t count, int step, Transcript& transcript);
  Time give_front(int step);
  /// All of it is nobody's: a probe's reply, and what comes behind it.
  void drop();
  /// Nobody was waiting for the first `count` bytes; or for any of it.
  void leave_over(std::size_t count, Transcript& transcript);
  void leave_over();

 private:
  EventAt pop();
  /// The first event, of at most `count` bytes.
  EventAt pop(std::size_t count, Transcript& transcript);

  std::deque<EventAt> events_;
  Bytes bytes_;
};

}  // namespace fieldproof::exchange
