#include "reports/text/report_file.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "reports/results/whole_file.hpp"

namespace fieldproof::text {
namespace {

class ReportFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = (folder_ / "report.xml").string();
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string content() const {
    const Result<std::string> text = results::read_whole_file(path_);
    return text ? *text : "";
  }
  long files() const {
    return std::distance(std::filesystem::directory_iterator(folder_),
                         std::filesystem::directory_iterator());
  }

  std::filesystem::path folder_;
  std::string path_;
};

TEST_F(ReportFileTest, AppearsWhenCommitted) {
  auto file = ReportFile::create(path_);
  ASSERT_TRUE(file) << file.error().message;
  file->out() << "whole";
  EXPECT_FALSE(std::filesystem::exists(path_));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ("whole", content());
  EXPECT_EQ(1, files());
}

TEST_F(ReportFileTest, AnOldReportStaysUntilTheNewIsWhole) {
  std::ofstream(path_) << "old";
  {
    auto file = ReportFile::create(path_);
    ASSERT_TRUE(file);
    file->out() << "half";
  }
  EXPECT_EQ("old", content());
  EXPECT_EQ(1, files()) << "nothing is left behind";
}

TEST_F(ReportFileTest, AFolderThatIsNotThereIsNamed) {
  auto file = ReportFile::create((folder_ / "none" / "r.xml").string());
  ASSERT_FALSE(file);
  EXPECT_THAT(
      file.error().message,
      testing::EndsWith(
          "none/r.xml: no such file or directory; check the path, and that its folder exists"));
}

TEST_F(ReportFileTest, ADeviceStaysADevice) {
  std::filesystem::create_symlink("/dev/null", path_);
  auto file = ReportFile::create(path_);
  ASSERT_TRUE(file);
  file->out() << "gone";
  ASSERT_TRUE(file->commit());
  EXPECT_TRUE(std::filesystem::is_character_file(path_));
  EXPECT_EQ(1, files());
}

TEST_F(ReportFileTest, AFullDiskIsAnError) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  auto file = ReportFile::create("/dev/full");
  ASSERT_TRUE(file);
  file->out() << "x";
  EXPECT_FALSE(file->commit());
}

}  // namespace
}  // namespace fieldproof::text
