// For tests: writes down the frames that a receiver finds.
#pragma once

#include <cstdint>
#include <vector>

#include "src/plc/frame_sink.hpp"

namespace fieldproof::plc::test {

class Log : public FrameSink {
 public:
  void on_frame(ByteView frame, Time end) override {
    frames.emplace_back(frame.begin(), frame.end());
    ends.push_back(end);
  }
  void on_broken_frame(std::uint16_t why) override { broken.push_back(why); }

  std::vector<Bytes> frames;
  std::vector<Time> ends;
  std::vector<std::uint16_t> broken;
};

using Broken = std::vector<std::uint16_t>;
using Frames = std::vector<Bytes>;

}  // namespace fieldproof::plc::test
