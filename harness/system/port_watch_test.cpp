#include "harness/system/port_watch.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace fieldproof::os {
namespace {

namespace fs = std::filesystem;

class Watching : public testing::Test {
 protected:
  Watching() {
    std::string pattern = testing::TempDir() + "fieldproof_watch_XXXXXX";
    folder_ = ::mkdtemp(pattern.data());
    fs::create_directory(folder_ / "lock");
  }
  ~Watching() override { fs::remove_all(folder_); }

  PortWatch watch(const std::string& port) const {
    return PortWatch((folder_ / port).string(), {(folder_ / "lock").string()});
  }
  void make(const std::string& name) const { std::ofstream(folder_ / name) << ' '; }

  static constexpr Duration at_once = 0ms, long_enough = 10s;
  fs::path folder_;
};

TEST_F(Watching, APortThatComesIsNoticed) {
  PortWatch port = watch("ttyUSB0");
  port.arm();
  EXPECT_FALSE(port.wait(at_once));
  make("ttyUSB0");
  EXPECT_TRUE(port.wait(long_enough));
}

TEST_F(Watching, AFolderThatComesIsNoticed) {
  PortWatch port = watch("serial/by-id/usb");
  port.arm();
  fs::create_directory(folder_ / "serial");
  EXPECT_TRUE(port.wait(long_enough));
}

TEST_F(Watching, WhoClosesThePortIsNoticed) {
  make("ttyUSB0");
  fs::create_symlink(folder_ / "ttyUSB0", folder_ / "usb");
  std::ofstream user(folder_ / "ttyUSB0");
  PortWatch port = watch("usb");
  port.arm();
  user.close();
  EXPECT_TRUE(port.wait(long_enough));
}

TEST_F(Watching, ALockThatGoesIsNoticedButNotOurOwnTrying) {
  make("ttyUSB0");
  make("lock/LCK..ttyUSB0");
  PortWatch port = watch("ttyUSB0");
  port.arm();
  make("lock/LTMP.abcdef");
  fs::remove(folder_ / "lock/LTMP.abcdef");
  EXPECT_FALSE(port.wait(1ms));
  fs::remove(folder_ / "lock/LCK..ttyUSB0");
  EXPECT_TRUE(port.wait(long_enough));
}

}  // namespace
}  // namespace fieldproof::os
