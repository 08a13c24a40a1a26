#include "harness/system/fd_link.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "harness/system/interrupt.hpp"
#include "harness/system/system_calls.hpp"

namespace fieldproof::os {

namespace {

/// Bytes that a process wrote before its end pass through a kernel work queue and may come after
/// the news of its end.
constexpr Duration last_bytes_limit = 20ms;
constexpr Duration end_limit = 200ms;

Time monotonic() {
  timespec t{};
  ::clock_gettime(CLOCK_MONOTONIC, &t);
  return std::chrono::seconds(t.tv_sec) + std::chrono::nanoseconds(t.tv_nsec);
}

/// poll() until a moment `left` from now; negative counts as 0.
int poll_for(pollfd* fds, nfds_t count, Duration left) {
  left = std::max(left, Duration::zero());
  const timespec timeout{static_cast<time_t>(left / 1s), static_cast<long>((left % 1s).count())};
  return ::ppoll(fds, count, &timeout, nullptr);
}

}  // namespace

RunClock::RunClock() : origin_(monotonic()) {}
Time RunClock::now() const { return monotonic() - origin_; }

Error interrupted_error(const char* verb, const std::string& name) {
  return Error{"cannot " + std::string(verb) + ' ' + name + ": interrupted", true};
}

FdLink::FdLink(UniqueFd fd, std::string name, RunClock clock)
    : fd_(std::move(fd)), name_(std::move(name)), clock_(clock) {
  ::fcntl(fd_.get(), F_SETFL, ::fcntl(fd_.get(), F_GETFL) | O_NONBLOCK);
  struct stat status {};
  socket_ = ::fstat(fd_.get(), &status) == 0 && S_ISSOCK(status.st_mode);
}

Error FdLink::gone(const char* verb, int error) {
  dead_ = true;
  if (far_end_) {
    // The link of a process that ends goes first.
    pollfd end{far_end_->end_fd(), POLLIN, 0};
    if (poll_for(&end, 1, end_limit) > 0) return ended(verb);
  }
  const std::string start = "cannot " + std::string(verb) + ' ' + name_ + ": ";
  if (socket_) {
    return fail(start +
                (error ? "the connection broke (" + errno_text(error) + ')'
                       : "the far end closed the connection") +
                "; see that the device or serial server still runs");
  }
  if (error != 0 && error != EIO && error != ENXIO && error != ENODEV)
    return fail(start + errno_text(error));
  return fail(start +
              "the far end is gone; see that the adapter is still plugged in, or that the process "
              "behind the pty still runs");
}

Error FdLink::ended(const char* verb) {
  dead_ = true;
  return fail("cannot " + std::string(verb) + ' ' + name_ + ": " + far_end_->how());
}

Result<Sent> FdLink::send(ByteView bytes) {
  if (interrupted()) return interrupted_error("send to", name_);
  if (far_end_ && far_end_->ended()) return ended("send to");
  Sent sent;
  sent.start = std::max(now(), sent_until_);
  sent.end = sent.start + character_time_ * static_cast<Duration::rep>(bytes.size());
  const Time give_up = sent.end + send_limit_;
  while (!bytes.empty()) {
    const ssize_t n = socket_ ? ::send(fd_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL)
                              : ::write(fd_.get(), bytes.data(), bytes.size());
    if (n >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    } else if (would_block(errno)) {
      if (const Status ready = wait_writable(give_up); !ready) return ready.error();
    } else if (errno != EINTR) {
      return gone("send to", errno);
    } else if (interrupted()) {
      return interrupted_error("send to", name_);
    }
  }
  if (character_time_ == Duration::zero()) {
    sent.end = now();
  } else {
    sent_until_ = sent.end;
    if (const Status over = wait_for_end(sent.end); !over) return over.error();
  }
  return sent;
}

Status FdLink::wait_writable(Time give_up) {
  std::array<pollfd, 3> fds{pollfd{fd_.get(), POLLOUT, 0}, pollfd{interrupt_fd(), POLLIN, 0},
                            pollfd{far_end_ ? far_end_->end_fd() : -1, POLLIN, 0}};
  const int ready = poll_for(fds.data(), fds.size(), give_up - now());
  if (interrupted()) return interrupted_error("send to", name_);
  if (ready == 0) {
    return fail(
        "cannot send to " + name_ +
        ": the far end takes no more bytes; see that it reads and that flow control is off");
  }
  if (ready > 0 && fds[0].revents == 0 && fds[2].revents != 0) return ended("send to");
  return ok();
}

/// The kernel takes bytes faster than the wire does. Waits until the last stop bit, so that pauses
/// count from there.
Status FdLink::wait_for_end(Time end) {
  for (Duration left = end - now(); left > Duration::zero(); left = end - now()) {
    if (interrupted()) return interrupted_error("send to", name_);
    pollfd stop{interrupt_fd(), POLLIN, 0};
    poll_for(&stop, 1, left);
  }
  return ok();
}

long FdLink::read_some(Byte* buffer, std::size_t size) const {
  ssize_t n = 0;
  do {
    n = ::read(fd_.get(), buffer, size);
  } while (n < 0 && errno == EINTR && !interrupted());
  return n;
}

Result<Burst> FdLink::receive(Time deadline) {
  std::array<Byte, 4096> buffer;  // a tty hands out no more at once
  for (bool far_end_over = far_end_ && far_end_->ended();;) {
    if (interrupted()) return interrupted_error("receive from", name_);
    const Time started = now();
    const bool waiting = deadline > started && !far_end_over;
    if (waiting) {
      std::array<pollfd, 3> fds{pollfd{fd_.get(), POLLIN, 0}, pollfd{interrupt_fd(), POLLIN, 0},
                                pollfd{far_end_ ? far_end_->end_fd() : -1, POLLIN, 0}};
      const int ready = poll_for(fds.data(), far_end_ ? 3 : 2, deadline - started);
      if (ready == 0) return Burst{{}, now(), {}};
      if (ready < 0 || fds[1].revents != 0) continue;
      far_end_over = fds[0].revents == 0;
    }
    if (far_end_over) {
      pollfd last{fd_.get(), POLLIN, 0};
      if (poll_for(&last, 1, last_bytes_limit) == 0) return ended("receive from");
    }
    const long n = read_some(buffer.data(), buffer.size());
    if (n > 0) return arrived(ByteView(buffer.data(), static_cast<std::size_t>(n)));
    if (n == 0 || (!would_block(errno) && errno != EINTR))
      return gone("receive from", n == 0 ? 0 : errno);
    if (!waiting && !interrupted()) return Burst{{}, now(), {}};
  }
}

/// The last stop bit was over when the bytes were read; on a wire the first began as much earlier
/// as they last, but not before the bytes read earlier had ended.
Burst FdLink::arrived(ByteView bytes) {
  const Time moment = now();
  Duration each = character_time_;
  if (each != Duration::zero())
    each = std::min(each, (moment - received_until_) / static_cast<Duration::rep>(bytes.size()));
  received_until_ = moment;
  return Burst{Bytes(bytes.begin(), bytes.end()),
               moment - each * static_cast<Duration::rep>(bytes.size()), each};
}

}  // namespace fieldproof::os
