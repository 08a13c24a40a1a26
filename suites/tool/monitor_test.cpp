// emulate --monitor: the frame monitor's CSV file.
#include <gmock/gmock.h>

#include <fstream>
#include <vector>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

/// One case against a device that the tool starts itself.
std::vector<std::string> monitored(const std::string& model) {
  const TestFolder folder;
  const std::string file = folder / "frames.csv";
  const Finished finished = run_tool(
      {"run", "--endpoint",
       "exec:" FIELDPROOF_TOOL " emulate " + model + " --pty {tty} --monitor " + file, "--profile",
       model, "--vectors", write_vectors(folder, many_vectors(1)), "--out", folder / "out"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  return lines_of(file);
}

TEST(Monitor, WritesEachFrameWithItsResult) {
  const std::vector<std::string> lines = monitored("xbc-h");
  ASSERT_GE(lines.size(), 3u);
  EXPECT_EQ(lines[0], "Form,Result,Size,Time,Frame data (HEX),Frame data (ASCII)\r");
  EXPECT_THAT(lines, testing::Contains(testing::MatchesRegex(
                         "Reception,XGT server,19,[0-9/]+ [0-9:.]+,05 30 31 72 53 53 "
                         ".*,\"\\[ENQ\\]01rSS0106%MW100\\[EOT\\]..\"\r")));
  EXPECT_THAT(lines, testing::Contains(testing::StartsWith("Transmission,XGT server,17,")));
}

TEST(Monitor, XbmCountsFromTheFirstFrame) {
  const std::vector<std::string> lines = monitored("xbm-s");
  ASSERT_GE(lines.size(), 3u);
  EXPECT_THAT(lines[1], testing::MatchesRegex("Reception,XGT server,[0-9]+,0\\.000 s,.*"));
}

TEST(Monitor, SaysWhichFileItCannotWrite) {
  const Finished finished = run_tool({"emulate", "xbc-h", "--monitor", "/nowhere/frames.csv"});
  EXPECT_EQ(finished.code, 2);
  EXPECT_THAT(finished.err,
              HasSubstr("cannot write /nowhere/frames.csv: No such file or directory"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
