// Loaded into the tool by tests (LD_PRELOAD): counts the calls that change a file or a port, and at
// the one whose number is MOMENT does what ACT says, so that a test can do it at any moment
// without a clock:
//   signal:15    the process gets that signal
//   full         from now on no disk has room for more than half of what is written
//   remove:DIR   the folder is gone
//   lock:DIR     nobody may write there any more, not even root
//   clock        from now on it is a day earlier
//   count        nothing; at its end the process says how many there were
#include <dirent.h>
#include <linux/capability.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>

namespace {

std::atomic<long> calls{0};
std::atomic<bool> full{false}, earlier{false};

/// Root may write everywhere by this capability.
void write_as_others_do() {
  __user_cap_header_struct head{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct caps[2]{};
  if (::syscall(SYS_capget, &head, caps) != 0) return;
  caps[0].effective &= ~(1u << CAP_DAC_OVERRIDE);
  ::syscall(SYS_capset, &head, caps);
}

void act(const std::string& what) {
  const std::string value = what.substr(what.find(':') + 1);
  std::error_code ignored;
  if (what.starts_with("signal:")) ::kill(::getpid(), std::atoi(value.c_str()));
  if (what.starts_with("remove:")) std::filesystem::remove_all(value, ignored);
  if (what.starts_with("lock:")) {
    write_as_others_do();
    ::chmod(value.c_str(), 0555);
  }
  full = full || what == "full";
  earlier = earlier || what == "clock";
}

void count() {
  static const char* const moment = std::getenv("MOMENT");
  static const char* const what = std::getenv("ACT");
  if (moment && what && ++calls == std::atol(moment)) act(what);
}

/// Says it behind everything else.
const struct Total {
  ~Total() {
    const char* const what = std::getenv("ACT");
    if (what && std::string(what) == "count") ::dprintf(2, "moments: %ld\n", calls.load());
  }
} total;

bool has_no_room(int fd) {
  struct stat info {};
  return full && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
}

ssize_t no_room() {
  errno = ENOSPC;
  return -1;
}

}  // namespace

extern "C" {

ssize_t write(int fd, const void* bytes, size_t size) {
  count();
  if (!has_no_room(fd)) return ::syscall(SYS_write, fd, bytes, size);
  return size < 2 ? no_room() : ::syscall(SYS_write, fd, bytes, size / 2);
}

ssize_t writev(int fd, const iovec* pieces, int number) {
  count();
  return has_no_room(fd) ? no_room() : ::syscall(SYS_writev, fd, pieces, number);
}

int rename(const char* from, const char* to) noexcept {
  count();
  return static_cast<int>(::syscall(SYS_rename, from, to));
}

int fdatasync(int fd) {
  count();
  return static_cast<int>(::syscall(SYS_fdatasync, fd));
}

time_t time(time_t* out) noexcept {
  timespec now{};
  ::syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
  const time_t told = now.tv_sec - (earlier ? 86'400 : 0);
  if (out) *out = told;
  return told;
}
}
