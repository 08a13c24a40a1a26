#include "harness/endpoints/serial_ports/receive_latency.hpp"

#include <fmt/format.h>
#include <linux/serial.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <fstream>

namespace fieldproof::endpoints {

namespace {

namespace fs = std::filesystem;

/// What the kernel may take to wake us.
constexpr Duration wake_up = 2ms;
/// A 16550 hands over fewer than its trigger level after four characters of silence.
constexpr int receive_time_out = 4;
/// What a run sets: bytes of a FIFO, ms of an adapter.
constexpr long at_once = 1;

std::optional<long> number_in(const fs::path& file) {
  std::ifstream stream(file);
  long value = 0;
  return stream >> value ? std::optional(value) : std::nullopt;
}

bool write_number(const fs::path& file, long value) {
  std::ofstream stream(file);
  return stream && stream << value << std::flush;
}

std::optional<bool> read_low_latency(const os::SystemCalls& calls, int fd) {
  serial_struct port{};
  if (calls.ioctl(fd, TIOCGSERIAL, &port) != 0) return std::nullopt;
  return (port.flags & ASYNC_LOW_LATENCY) != 0;
}

void set_low_latency(const os::SystemCalls& calls, int fd, bool on) {
  serial_struct port{};
  if (calls.ioctl(fd, TIOCGSERIAL, &port) != 0) return;
  const int flags = on ? port.flags | ASYNC_LOW_LATENCY : port.flags & ~ASYNC_LOW_LATENCY;
  if (flags == port.flags) return;
  port.flags = flags;
  calls.ioctl(fd, TIOCSSERIAL, &port);
}

/// The port's name in /sys/class/tty, whatever link it was given by.
std::string terminal_name(const std::string& port) {
  std::error_code none;
  return fs::canonical(port, none).filename();
}

}  // namespace

void ReceiveLatency::Number::read(fs::path from, std::optional<long> left) {
  file = std::move(from);
  before = now = number_in(file);
  if (left && now == at_once) before = left;  // else somebody has set it since
}

void ReceiveLatency::Number::set(long wanted) {
  now = number_in(file);  // low_latency may have changed it
  if (!now || *now <= wanted) return;
  if (write_number(file, wanted)) now = number_in(file);
}

void ReceiveLatency::Number::put_back() const {
  if (before && number_in(file) != before) write_number(file, *before);
}

std::string ReceiveLatency::Number::describe() const {
  if (!now) return "";
  const std::string name = file.filename();
  if (now != before) return fmt::format("{} {} for this run, else {}", name, *now, *before);
  return *now > 1 ? fmt::format("{} {}, which root can set to 1", name, *now)
                  : fmt::format("{} {}", name, *now);
}

ReceiveLatency::ReceiveLatency(const os::SystemCalls& calls, int fd, const std::string& port,
                               const fs::path& terminals, const fs::path& notes)
    : calls_(calls), fd_(fd), note_(notes, terminal_name(port)) {
  const fs::path terminal = terminals / terminal_name(port);
  const LatencyBefore left = note_.read();
  trigger_.read(terminal / "rx_trig_bytes", left.trigger);
  timer_.read(terminal / "device" / "latency_timer", left.timer);
  low_latency_ = read_low_latency(calls_, fd_);
  if (low_latency_ && left.low_latency) low_latency_ = left.low_latency;
  if (low_latency_ || trigger_.before || timer_.before)
    note_.keep({low_latency_, trigger_.before, timer_.before});
  set_low_latency(calls_, fd_, true);
  trigger_.set(at_once);
  timer_.set(at_once);
}

ReceiveLatency::~ReceiveLatency() {
  if (low_latency_) set_low_latency(calls_, fd_, *low_latency_);
  trigger_.put_back();
  timer_.put_back();
  note_.drop();
}

std::optional<Duration> ReceiveLatency::silence(Duration character_time) const {
  if (timer_.now) return std::max(*timer_.now, 1L) * 1ms + wake_up;
  if (!trigger_.now) return std::nullopt;
  return wake_up + (*trigger_.now > 1 ? receive_time_out * character_time : Duration{});
}

std::optional<Duration> ReceiveLatency::pause(Duration character_time) const {
  const std::optional<Duration> back_dated = silence(character_time);
  if (!back_dated || !trigger_.now) return back_dated;
  return *back_dated + *trigger_.now * character_time;
}

std::string ReceiveLatency::describe() const {
  const std::string trigger = trigger_.describe(), timer = timer_.describe();
  return trigger + (trigger.empty() || timer.empty() ? "" : ", ") + timer;
}

}  // namespace fieldproof::endpoints
