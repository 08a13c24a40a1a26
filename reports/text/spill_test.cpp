#include "reports/text/spill.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <sstream>

namespace fieldproof::text {
namespace {

namespace fs = std::filesystem;

/// Lines up to `size` bytes, no two alike.
std::string lines(std::size_t size) {
  std::string text;
  for (int i = 0; text.size() < size; ++i) text += std::to_string(i) + '\n';
  return text;
}

TEST(Spill, GivesBackWhatItTook) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{10}, Spill::room, 5 * Spill::room}) {
    Spill spill(fs::path(testing::TempDir()) / "report");
    const std::string text = lines(size);
    for (std::size_t at = 0; at < text.size(); at += 1000)
      ASSERT_TRUE(spill.append(std::string_view(text).substr(at, 1000)));
    for (int again = 0; again < 2; ++again) {
      std::ostringstream out;
      ASSERT_TRUE(spill.copy_to(out));
      EXPECT_EQ(text, out.str());
    }
  }
}

TEST(Spill, LeavesNothingInTheFolder) {
  const fs::path folder = fs::path(testing::TempDir()) / "spill";
  fs::remove_all(folder);
  fs::create_directories(folder);
  Spill spill((folder / "report").string());
  ASSERT_TRUE(spill.append(lines(3 * Spill::room)));
  EXPECT_TRUE(fs::is_empty(folder)) << "nobody but us sees it, and a kill leaves nothing";
  fs::remove_all(folder);
}

TEST(Spill, AFolderThatRefusesIsNoTrouble) {
  Spill spill("/proc/report");  // as /dev/stdout of a user is: its folder takes no files
  const std::string text = lines(3 * Spill::room);
  ASSERT_TRUE(spill.append(text));
  std::ostringstream out;
  ASSERT_TRUE(spill.copy_to(out));
  EXPECT_EQ(text, out.str());
}

TEST(Spill, TwoDoNotMix) {
  Spill one("one"), other("other");
  ASSERT_TRUE(one.append(lines(2 * Spill::room)));
  Spill moved(std::move(one));
  ASSERT_TRUE(other.append("other"));
  ASSERT_TRUE(moved.append("end"));
  std::ostringstream out;
  ASSERT_TRUE(moved.copy_to(out));
  EXPECT_EQ(lines(2 * Spill::room) + "end", out.str());
}

}  // namespace
}  // namespace fieldproof::text
