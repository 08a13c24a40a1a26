#include "harness/endpoints/serial_ports/receive_latency.hpp"

#include <gtest/gtest.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>

namespace fieldproof::endpoints {
namespace {

namespace fs = std::filesystem;

constexpr Duration character = 1ms;

class ReceiveLatencyOf : public testing::Test {
 protected:
  ReceiveLatencyOf() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "ttyX" / "device");
    std::ofstream(port_) << "";
    calls_.ioctl = [this](int, unsigned long request, void* argument) {
      auto* port = static_cast<serial_struct*>(argument);
      if (request == TIOCGSERIAL) return port->flags = flags_, 0;
      if (request == TIOCSSERIAL) return flags_ = port->flags, 0;
      errno = ENOTTY;
      return -1;
    };
  }
  void shows(const std::string& file, long value) {
    std::ofstream(folder_ / "ttyX" / file) << value << '\n';
  }
  long shown(const std::string& file) {
    long value = -1;
    std::ifstream(folder_ / "ttyX" / file) >> value;
    return value;
  }
  ReceiveLatency open() { return {calls_, -1, port_, folder_, notes_}; }
  /// Opens the port in a process that ends without a destructor.
  void open_and_be_killed() {
    const pid_t child = ::fork();
    if (child == 0) {
      const ReceiveLatency port = open();
      ::_exit(0);
    }
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    flags_ |= ASYNC_LOW_LATENCY;  // of the driver, not of the process
  }

  const fs::path folder_ = fs::path(testing::TempDir()) / "receive_latency";
  const std::string port_ = folder_ / "ttyX" / "ttyX";
  const fs::path notes_ = folder_ / "notes";
  os::SystemCalls calls_ = os::real_system_calls();
  int flags_ = ASYNC_SKIP_TEST;
};

TEST_F(ReceiveLatencyOf, AFifoIsToldToHandOverEachByte) {
  shows("rx_trig_bytes", 8);
  {
    const ReceiveLatency port = open();
    EXPECT_EQ(shown("rx_trig_bytes"), 1);
    EXPECT_TRUE(flags_ & ASYNC_LOW_LATENCY);
    EXPECT_EQ(port.silence(character), 2ms) << "what the kernel takes to wake us";
    EXPECT_EQ(port.pause(character), 3ms) << "and the character itself";
    EXPECT_EQ(port.describe(), "rx_trig_bytes 1 for this run, else 8");
  }
  EXPECT_EQ(shown("rx_trig_bytes"), 8);
  EXPECT_EQ(flags_, ASYNC_SKIP_TEST) << "as it was";
}

TEST_F(ReceiveLatencyOf, AFifoThatCannotBeToldMakesFourCharactersOfSilence) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write whatever the permissions are";
  shows("rx_trig_bytes", 8);
  fs::permissions(folder_ / "ttyX" / "rx_trig_bytes", fs::perms::owner_read);
  const ReceiveLatency port = open();
  EXPECT_EQ(port.silence(character), 6ms);
  EXPECT_EQ(port.pause(character), 14ms) << "eight characters that are gathered";
  EXPECT_EQ(port.describe(), "rx_trig_bytes 8, which root can set to 1");
}

TEST_F(ReceiveLatencyOf, AnAdapterIsToldToHandOverAfterAMillisecond) {
  shows("device/latency_timer", 16);
  {
    const ReceiveLatency port = open();
    EXPECT_EQ(shown("device/latency_timer"), 1);
    EXPECT_EQ(port.silence(character), 3ms);
    EXPECT_EQ(port.describe(), "latency_timer 1 for this run, else 16");
  }
  EXPECT_EQ(shown("device/latency_timer"), 16);
}

TEST_F(ReceiveLatencyOf, WhatWasSetBeforeIsLeft) {
  flags_ |= ASYNC_LOW_LATENCY;
  shows("device/latency_timer", 1);
  EXPECT_EQ(open().describe(), "latency_timer 1");
  EXPECT_TRUE(flags_ & ASYNC_LOW_LATENCY);
}

TEST_F(ReceiveLatencyOf, WhatAKilledRunLeftIsPutBackByTheNext) {
  shows("rx_trig_bytes", 8);
  shows("device/latency_timer", 16);
  open_and_be_killed();
  open_and_be_killed();
  EXPECT_EQ(shown("rx_trig_bytes"), 1);
  EXPECT_EQ(open().describe(),
            "rx_trig_bytes 1 for this run, else 8, latency_timer 1 for this run, else 16");
  EXPECT_EQ(shown("rx_trig_bytes"), 8);
  EXPECT_EQ(shown("device/latency_timer"), 16);
  EXPECT_EQ(flags_, ASYNC_SKIP_TEST);
  EXPECT_TRUE(fs::is_empty(notes_));
}

TEST_F(ReceiveLatencyOf, WhatSomebodySetAfterAKilledRunIsLeft) {
  shows("rx_trig_bytes", 8);
  open_and_be_killed();
  shows("rx_trig_bytes", 4);
  EXPECT_EQ(open().describe(), "rx_trig_bytes 1 for this run, else 4");
  EXPECT_EQ(shown("rx_trig_bytes"), 4);
}

TEST_F(ReceiveLatencyOf, AnotherStartOfTheSystemLeftNothing) {
  shows("rx_trig_bytes", 8);
  open_and_be_killed();
  std::ofstream(notes_ / "ttyX.json") << R"({"start":"another","rx_trig_bytes":8})";
  EXPECT_EQ(open().describe(), "rx_trig_bytes 1");
}

TEST_F(ReceiveLatencyOf, ANoteThatIsNoneIsLeftOut) {
  shows("rx_trig_bytes", 1);
  fs::create_directories(notes_);
  for (const char* text : {"", "{", "[]", R"({"start":7,"low_latency":7})"}) {
    std::ofstream(notes_ / "ttyX.json") << text;
    EXPECT_EQ(open().describe(), "rx_trig_bytes 1") << text;
  }
}

TEST_F(ReceiveLatencyOf, AnotherDriverDoesNotTell) {
  const ReceiveLatency port = open();
  EXPECT_EQ(port.silence(character), std::nullopt);
  EXPECT_EQ(port.pause(character), std::nullopt);
  EXPECT_EQ(port.describe(), "");
}

}  // namespace
}  // namespace fieldproof::endpoints
