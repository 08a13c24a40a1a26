// Endpoint option echo=on: on a line where the bench hears itself (a two-wire RS-485 adapter with
// echo), what it has sent is taken out of what it receives.
#pragma once

#include <deque>
#include <memory>
#include <string>

#include "harness/endpoints/endpoint.hpp"

namespace fieldproof::endpoints {

/// Takes out exactly the bytes that were sent, each sending once and in its order, in whatever
/// pieces they come back. Pure.
class EchoFilter {
 public:
  /// How much later than its last stop bit a sending may still come back.
  static constexpr Duration patience = 500ms;

  /// What was sent, before anything is taken that came since it began.
  void sent(ByteView bytes, Time end);
  /// What came on the line. What may be the beginning of an echo is held back until that is known.
  void take(const Burst& burst);
  /// Gives up the echoes that are overdue, and lets go what was held back for them.
  void expire(Time now);
  /// The same for all that has been answered, or something else has come since: the line is asked
  /// anew, or a case is over.
  void conclude(Time now);
  /// All that is held back: nothing more will come.
  void let_go();
  /// Forgets what is under way: another case begins.
  void clear();

  /// What has come beside echoes, piece by piece; nothing: no more of it.
  std::optional<Burst> next();

  std::size_t removed() const { return removed_; }  // echoes that came back as they were sent
  std::size_t lost() const { return lost_; }        // those that did not
  /// Those lost since the last call: "1 missing or damaged echo (of 05 30 31)", or empty.
  std::string take_troubles();

 private:
  struct Sending {
    Bytes bytes;
    Time end{};
    bool overtaken = false;  // something else has come since its end
  };
  struct Held {
    Byte value{};
    Time start{};
    Duration character_time{};
    bool first = false;  // of its burst
  };

  bool is_beginning(const Sending& sending) const;
  bool settle();
  void lose(std::size_t index);
  void release();

  std::deque<Sending> under_way_;
  std::deque<Held> held_;
  std::deque<Burst> ready_;
  std::size_t removed_ = 0, lost_ = 0, told_ = 0;
  Bytes last_lost_;
};

/// Check of the option: "on" or "off"; the error is the cause alone.
Status check_echo(const EndpointName& name, const harness::Protocol& protocol);
bool removes_echo(const EndpointName& name);

/// `line` without its echo. A send fails where nothing has ever come back: the line has no echo.
std::unique_ptr<Endpoint> without_echo(std::unique_ptr<Endpoint> line);

}  // namespace fieldproof::endpoints
