#include "reports/results/whole_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace fieldproof::results {
namespace {

TEST(WholeFile, HasEveryByte) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "whole_file";
  const std::string bytes = std::string("\0\r\n\xFF", 4) + std::string(200'000, 'x');
  std::ofstream(path, std::ios::binary) << bytes;
  EXPECT_EQ(*read_whole_file(path), bytes);
  std::ofstream(path, std::ios::trunc).close();
  EXPECT_EQ(*read_whole_file(path), "");
  std::filesystem::remove(path);
}

TEST(WholeFile, NamesFileAndCause) {
  EXPECT_THAT(read_whole_file("no/such.json").error().message,
              testing::StartsWith("cannot read no/such.json: no such file or directory; check"));
  EXPECT_THAT(read_whole_file("no/such.json", "profile").error().message,
              testing::StartsWith("cannot read profile no/such.json: "));
  EXPECT_THAT(read_whole_file(testing::TempDir()).error().message,
              testing::HasSubstr("is a directory; name a file in it"));
}

}  // namespace
}  // namespace fieldproof::results
