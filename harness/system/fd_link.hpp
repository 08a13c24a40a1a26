// Bytes with times over a file descriptor: a terminal, a pty or a socket.
#pragma once

#include <string>

#include "harness/system/unique_fd.hpp"
#include "src/base/bytes.hpp"
#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/line/device.hpp"

namespace fieldproof::os {

/// Real time of a run: nanoseconds of CLOCK_MONOTONIC since it was made.
class RunClock {
 public:
  RunClock();
  Time now() const;

 private:
  Time origin_{};
};

/// A process that a link depends on. Its end is noticed while waiting, although the bench itself
/// keeps the pty open.
class FarEnd {
 public:
  virtual ~FarEnd() = default;
  /// Readable once it has ended.
  virtual int end_fd() const = 0;
  /// Without a system call; may be late by a moment.
  virtual bool ended() const = 0;
  /// "the process ended with exit status 3; it said: cannot open port"
  virtual std::string how() = 0;
};

class FdLink {
 public:
  /// Takes over `fd` and makes it non-blocking. `name` is for messages: "serial:/dev/ttyUSB0".
  FdLink(UniqueFd fd, std::string name, RunClock clock = {});

  /// On a real line, one character: sent bytes end, and received bytes begin, by this time. 0 (pty,
  /// socket): no wire.
  void set_character_time(Duration character_time) { character_time_ = character_time; }
  /// How long a send waits for a far end that takes no bytes.
  void set_send_limit(Duration limit) { send_limit_ = limit; }
  /// `far_end` outlives the link or is replaced first; nullptr: none.
  void set_far_end(FarEnd* far_end) { far_end_ = far_end; }

  int fd() const { return fd_.get(); }
  /// The far end closed, or the port failed: every later call fails too.
  bool dead() const { return dead_; }
  Time now() const { return clock_.now(); }

  /// Sends all. On a real line it returns when the last stop bit is over. Errors: interrupted, the
  /// far end is gone, or it takes no bytes (3 s).
  Result<Sent> send(ByteView bytes);

  /// The next bytes up to `deadline` (in the past: what is there), or an empty burst. Bytes that a
  /// dead far end left behind are still handed out. Errors: interrupted, the far end is gone.
  Result<Burst> receive(Time deadline);

 private:
  Status wait_writable(Time give_up);
  Status wait_for_end(Time end);
  long read_some(Byte* buffer, std::size_t size) const;
  Burst arrived(ByteView bytes);
  Error gone(const char* verb, int error);
  Error ended(const char* verb);

  UniqueFd fd_;
  std::string name_;
  RunClock clock_;
  FarEnd* far_end_ = nullptr;
  Duration character_time_{};
  Duration send_limit_ = 3s;
  Time sent_until_{};
  Time received_until_{};
  bool socket_ = false;
  bool dead_ = false;
};

/// "cannot VERB NAME: interrupted", with the flag.
Error interrupted_error(const char* verb, const std::string& name);

}  // namespace fieldproof::os
