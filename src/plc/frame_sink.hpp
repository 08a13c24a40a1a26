// Who takes the frames that a receiver finds.
#pragma once

#include <cstdint>

#include "src/base/bytes.hpp"
#include "src/base/time.hpp"

namespace fieldproof::plc {

class FrameSink {
 public:
  /// A complete frame. `end`: the moment at which it is known to be complete.
  virtual void on_frame(ByteView frame, Time end) = 0;
  /// No frame; why: service_status (counters.hpp).
  virtual void on_broken_frame(std::uint16_t why) = 0;

 protected:
  ~FrameSink() = default;
};

}  // namespace fieldproof::plc
