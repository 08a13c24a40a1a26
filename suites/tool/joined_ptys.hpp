// Two ptys that socat joins: a serial port for the bench, with a device on its other end. For
// tests.
#pragma once

#include <memory>
#include <string>

#include "suites/tool/tool.hpp"

namespace fieldproof::tool_tests {

class JoinedPtys {
 public:
  /// `emulated` sits on the device's end; empty: nobody does.
  explicit JoinedPtys(const std::string& emulated = "")
      : socat_({"socat", "-d", "-d", "pty,raw,echo=0,link=" + bench(),
                "pty,raw,echo=0,link=" + device()}) {
    EXPECT_TRUE(socat_.wait_for("starting data transfer loop"));
    if (emulated.empty()) return;
    device_ = std::make_unique<Process>(
        std::vector<std::string>{FIELDPROOF_TOOL, "emulate", emulated, "--pty", device()});
    EXPECT_TRUE(device_->wait_for(device()));
  }
  std::string bench() const { return folder_ / "bench"; }
  std::string device() const { return folder_ / "device"; }

 private:
  TestFolder folder_;
  Process socat_;
  std::unique_ptr<Process> device_;
};

}  // namespace fieldproof::tool_tests
