// One end of a TCP connection: the bytes that came on it, and how it ended.
#pragma once

#include <poll.h>

#include <optional>

#include "harness/system/unique_fd.hpp"
#include "src/base/burst.hpp"

namespace fieldproof::os {

/// What came on a link.
struct Arrival {
  LinkEvent event = LinkEvent::data;
  Bytes bytes{};
};

/// Never waits. A reset that answers to what is sent after the other side's FIN is no event: that
/// side had ended the connection.
class Connection {
 public:
  /// Takes over a non-blocking socket that is connected or will be; one without a descriptor was
  /// refused: `reset` is all that comes on it.
  explicit Connection(UniqueFd fd);
  Connection(Connection&&) = default;
  Connection& operator=(Connection&&) = default;
  /// One that has vanished ends by RST, so that it keeps no place at the other side.
  ~Connection();

  /// What has come next: data, `closed` (FIN) or `reset` (RST, the last), each ending once;
  /// nothing: nothing is there.
  std::optional<Arrival> read();

  /// The last `read` left nothing behind.
  bool has_read_all() const { return read_all_; }
  /// Its end came from this side, so that no poll tells it: `read` does.
  bool has_broken() const { return hears_ && !fd_; }

  /// Sends what the socket takes; the rest waits for `flush`. What the other side no longer takes,
  /// having ended the connection, is dropped; so is the connection where eight megabytes wait.
  void write(ByteView bytes);
  void flush();
  bool has_waiting() const { return !out_.empty(); }
  /// A megabyte waits: until the other side reads on, nothing is to be read here. So a client that
  /// asks on and on without reading is stopped by its own connection, and no answer is lost.
  bool is_full() const { return out_.size() > enough_waiting; }
  /// The other side has taken it, and it has not ended.
  bool stands() const { return fd_ && !connecting_; }

  /// FIN (behind what waits) or RST; after RST and `vanish` nothing is heard any more. The kernel
  /// goes on acknowledging for one that has vanished, as long as it has room for what comes.
  void close(Closing how);
  /// This side has not closed.
  bool is_open() const { return open_; }
  /// Neither side has anything more to say, and its end has been read.
  bool is_over() const { return !fd_ && !hears_; }

  /// What to wait for, or but for what comes; descriptor -1: nothing.
  pollfd to_poll(bool hearing = true) const;

 private:
  static constexpr std::size_t enough_waiting = 1 << 20;

  void send_fin();
  void end_at_once();
  void end_if_both_closed();

  UniqueFd fd_;
  Bytes out_;             // accepted by `write`, not by the kernel
  bool open_ = true;      // this side has not closed
  bool hears_ = true;     // the other side has not, nor has this one given up hearing
  bool fin_due_ = false;  // behind what waits
  bool fin_sent_ = false;
  bool broken_ = false;  // a send has met the other side's reset
  bool connecting_ = false;
  bool read_all_ = false;
};

}  // namespace fieldproof::os
