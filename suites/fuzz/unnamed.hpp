// A file that has no name: what reads paths reads this.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <string>

#include "harness/system/unique_fd.hpp"
#include "src/base/bytes.hpp"
#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

class Unnamed {
 public:
  explicit Unnamed(ByteView content) : fd_(::memfd_create("input", MFD_CLOEXEC)) {
    const auto written = ::write(fd_.get(), content.data(), content.size());
    rule(written == static_cast<ssize_t>(content.size()), "there is memory for the input");
  }
  std::string path() const { return "/proc/self/fd/" + std::to_string(fd_.get()); }

 private:
  os::UniqueFd fd_;
};

}  // namespace fieldproof::fuzz
