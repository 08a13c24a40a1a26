// The body of a report whose head needs totals: kept until the head is known, in little memory.
#pragma once

#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::text {

/// Text that grows: the last of it in memory, what is more in a file without a name, which goes
/// with the object and with the program, however it ends.
class Spill {
 public:
  /// `path`: the report that it is for, which errors name. The file is beside it.
  explicit Spill(std::string path) : path_(std::move(path)) {}
  Spill(Spill&& other) noexcept;
  Spill& operator=(Spill&&) = delete;
  ~Spill();

  Status append(std::string_view text);
  /// All of it, from the beginning.
  Status copy_to(std::ostream& out);

  static constexpr std::size_t room = 1u << 18;  // bytes in memory

 private:
  Status flush();

  std::string path_;
  std::string text_;  // behind what is in the file
  int fd_ = -1;
};

}  // namespace fieldproof::text
