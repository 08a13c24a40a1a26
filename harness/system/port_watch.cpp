#include "harness/system/port_watch.hpp"

#include <poll.h>
#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <string_view>

#include "harness/system/interrupt.hpp"

namespace fieldproof::os {

namespace {

namespace fs = std::filesystem;

/// The nearest folder above it that there is: an adapter may take /dev/serial with it.
fs::path folder_above(const fs::path& path) {
  std::error_code none;
  fs::path folder = fs::absolute(path).parent_path();
  while (!fs::exists(folder, none) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

int milliseconds(Duration time) {
  return static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(time).count());
}

}  // namespace

PortWatch::PortWatch(std::string port, std::vector<std::string> folders)
    : port_(std::move(port)),
      lock_folders_(std::move(folders)),
      fd_(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {}

void PortWatch::watch(const std::string& path, unsigned events) {
  ::inotify_add_watch(fd_.get(), path.c_str(), events);  // what is not there is not watched
}

void PortWatch::arm() {
  constexpr unsigned made = IN_CREATE | IN_MOVED_TO | IN_ATTRIB;
  constexpr unsigned closed = IN_CLOSE | IN_ATTRIB;
  watch(folder_above(port_).string(), made);
  std::error_code none;
  if (const fs::path real = fs::canonical(port_, none); !none) {
    watch(real.parent_path().string(), made);
    watch(real.string(), closed);
  }
  for (const std::string& folder : lock_folders_) watch(folder, IN_DELETE | IN_CLOSE_WRITE);
}

bool PortWatch::take_events() {
  bool any = false;
  alignas(inotify_event) std::array<char, 4096> buffer;
  for (ssize_t size; (size = ::read(fd_.get(), buffer.data(), buffer.size())) > 0;) {
    for (ssize_t at = 0; at < size;) {
      inotify_event event;
      std::memcpy(&event, buffer.data() + at, sizeof event);
      const char* name = buffer.data() + at + sizeof event;
      // The file that becomes a lock: our own trying makes one, too.
      any |= event.len == 0 || !std::string_view(name).starts_with("LTMP.");
      at += static_cast<ssize_t>(sizeof event + event.len);
    }
  }
  return any;
}

bool PortWatch::wait(Duration limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!interrupted()) {
    const Duration left = deadline - std::chrono::steady_clock::now();
    if (left <= 0ns) return false;
    std::array<pollfd, 2> fds{pollfd{fd_.get(), POLLIN, 0}, pollfd{interrupt_fd(), POLLIN, 0}};
    if (::poll(fds.data(), fds.size(), milliseconds(left)) == 1 && take_events()) return true;
  }
  return false;
}

void pause_for(Duration time) {
  pollfd interrupt{interrupt_fd(), POLLIN, 0};
  ::poll(&interrupt, 1, milliseconds(time));
}

}  // namespace fieldproof::os
