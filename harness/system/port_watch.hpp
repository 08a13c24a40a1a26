// Waits for a port of this computer that is absent or in use.
#pragma once

#include <string>
#include <vector>

#include "harness/system/port_lock.hpp"
#include "harness/system/unique_fd.hpp"
#include "src/base/time.hpp"

namespace fieldproof::os {

class PortWatch {
 public:
  /// `folders`: where the locks of ports lie.
  explicit PortWatch(std::string port, std::vector<std::string> folders = os::lock_folders());

  /// From now on nothing is missed: to be called before the port is tried.
  void arm();
  /// Until the port may be there or free, as the system tells: its file or a folder above it is
  /// made, it is closed by somebody, a lock file goes. False: `limit` is over, or Ctrl-C.
  bool wait(Duration limit);

 private:
  void watch(const std::string& path, unsigned events);
  /// Is there one that is not of our own trying?
  bool take_events();

  std::string port_;
  std::vector<std::string> lock_folders_;
  UniqueFd fd_;
};

/// Lets time pass, until Ctrl-C.
void pause_for(Duration time);

}  // namespace fieldproof::os
