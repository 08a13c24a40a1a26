#include "harness/system/stable_name.hpp"

#include <gtest/gtest.h>
#include <filesystem>
#include <fstream>

namespace fieldproof::os {
namespace {

TEST(StableName, IsTheLinkThatLeadsToThePort) {
  namespace fs = std::filesystem;
  const fs::path root = fs::path(testing::TempDir()) / "stable_name";
  fs::remove_all(root);
  fs::create_directories(root / "by-id");
  for (const char* port : {"ttyUSB0", "ttyUSB1", "ttyUSB2"}) std::ofstream(root / port) << "";
  fs::create_symlink("../ttyUSB0", root / "by-id" / "usb-FTDI-if00");
  fs::create_symlink("../ttyUSB1", root / "by-id" / "usb-Prolific-if00");
  fs::create_symlink("../gone", root / "by-id" / "usb-gone-if00");
  fs::create_symlink("ttyUSB0", root / "plc");
  const auto name = [&](const std::string& port) {
    return stable_name((root / port).string(), (root / "by-id").string());
  };
  EXPECT_EQ(name("ttyUSB1"), (root / "by-id" / "usb-Prolific-if00").string());
  EXPECT_EQ(name("ttyUSB2"), "") << "no link";
  EXPECT_EQ(name("nothing"), "");
  EXPECT_EQ(name("plc"), "") << "a name that somebody chose";
  EXPECT_EQ(name("by-id/usb-FTDI-if00"), "");
  EXPECT_EQ(stable_name((root / "ttyUSB0").string(), (root / "none").string()), "");
  fs::remove_all(root);
}

}  // namespace
}  // namespace fieldproof::os
