// How a serial driver hands over what it has received: a UART gathers characters in its FIFO, a USB
// adapter for some milliseconds. Silence that they make is not the device's.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "harness/endpoints/serial_ports/latency_note.hpp"
#include "harness/system/state_folder.hpp"
#include "harness/system/system_calls.hpp"
#include "src/base/time.hpp"

namespace fieldproof::endpoints {

/// Tells the driver of an open port to hand over at once, as far as it lets us (low_latency by
/// ioctl; as root the trigger level of an 8250 and the latency timer of an FTDI adapter, too). The
/// destructor puts all of it back, and what a run of the same user left that was killed. `fd`
/// outlives it.
class ReceiveLatency {
 public:
  ReceiveLatency(const os::SystemCalls& calls, int fd, const std::string& port,
                 const std::filesystem::path& terminals = "/sys/class/tty",
                 const std::filesystem::path& notes = os::state_folder("ports"));
  ~ReceiveLatency();
  ReceiveLatency(const ReceiveLatency&) = delete;
  ReceiveLatency& operator=(const ReceiveLatency&) = delete;

  /// Silence that may appear between two characters that came without a pause, where the first of
  /// what is handed over at once is dated back by its length. Nothing: the driver does not tell.
  std::optional<Duration> silence(Duration character_time) const;
  /// The same between one handing over and the next.
  std::optional<Duration> pause(Duration character_time) const;
  /// "rx_trig_bytes 1 for this run, else 8", "latency_timer 16, which root can set to 1"; or empty.
  std::string describe() const;

 private:
  /// A number that the driver shows in a file.
  struct Number {
    std::filesystem::path file;
    std::optional<long> before, now;

    /// `left`: how it was before a run that was killed.
    void read(std::filesystem::path from, std::optional<long> left);
    void set(long wanted);
    void put_back() const;
    std::string describe() const;
  };

  os::SystemCalls calls_;
  int fd_;
  LatencyNote note_;
  std::optional<bool> low_latency_;  // how it was; nothing: the driver has none
  Number trigger_;                   // bytes in the FIFO of an 8250
  Number timer_;                     // ms of a USB adapter
};

}  // namespace fieldproof::endpoints
