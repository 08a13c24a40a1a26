// The end of a fieldbus that an emulated device has: what it and a device in another process tell
// each other in place of frames that no manual prints. Lines of text; the host carries them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"

namespace fieldproof::plc {

class BusEnd {
 public:
  virtual ~BusEnd() = default;

  /// The first line to the other end, as soon as the two are joined.
  virtual std::string hello() const = 0;
  /// A line of the other end. Errors say why the two do not fit together.
  virtual Status hear(std::string_view line) = 0;
  /// The other end is gone.
  virtual void part() = 0;
  /// What is to be told since the last call.
  virtual std::vector<std::string> take_lines() = 0;
};

}  // namespace fieldproof::plc
