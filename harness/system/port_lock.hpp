// One user of a serial port at a time, and a name for whoever has it: the lock files of UUCP, which
// minicom, cu, pppd and ser2net keep as well.
#pragma once

#include <string>
#include <vector>

#include "harness/system/unique_fd.hpp"
#include "src/base/result.hpp"

namespace fieldproof::os {

/// Where lock files go, the first that can be written: /var/lock, else the user's own run folder
/// (XDG_RUNTIME_DIR).
std::vector<std::string> lock_folders();

/// A file FOLDER/LCK..ttyUSB0 that holds our process id for as long as this object lives; it has
/// further names by the link that was given (ser2net does not follow links) and by the device's
/// numbers (LCK.188.000). It is also locked by flock: that lock goes with the process, however it
/// ends, so a file of ours that nobody holds is stale even where its process id has been given to
/// another process meanwhile.
class PortLock {
 public:
  /// Links are followed: each name of a port has the same lock. Nothing is held where there is no
  /// such port, or no folder can be written (then the exclusive opening of the port must do).
  /// Errors: "cannot open /dev/ttyUSB0: the port is in use by process 1234 (minicom) since
  /// 2026-11-21 15:52 ...".
  static Result<PortLock> acquire(const std::string& port,
                                  const std::vector<std::string>& folders = lock_folders());
  PortLock(PortLock&&) noexcept = default;
  PortLock& operator=(PortLock&&) = delete;
  ~PortLock();

  /// The names of the file. Empty: nothing is held.
  const std::vector<std::string>& paths() const { return paths_; }
  /// What the user should know: a stale lock was taken over. Or empty.
  const std::string& notice() const { return notice_; }

 private:
  PortLock() = default;
  Status take(const std::string& port, const std::string& folder, const std::string& temporary,
              const std::vector<std::string>& names);

  UniqueFd fd_;
  std::vector<std::string> paths_;
  std::string notice_;
};

}  // namespace fieldproof::os
