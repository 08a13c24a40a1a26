// The installed tool: finds its vectors and profiles beside itself, wherever it is started.
#include <gmock/gmock.h>

#include <set>

#include <memory>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

class Installed : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TestFolder>();
    const Finished finished =
        run_program({"cmake", "--install", FIELDPROOF_BINARY_DIR, "--prefix", *folder_ / "usr"});
    ASSERT_EQ(finished.code, 0) << finished.out << finished.err;
    std::filesystem::create_directory(*folder_ / "elsewhere");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  /// The tool that is installed in this folder of ours.
  static Finished run(std::vector<std::string> arguments, const std::string& prefix = "usr") {
    arguments.insert(arguments.begin(), *folder_ / (prefix + "/bin/fieldproof"));
    return run_program(arguments, {.environment = {}, .folder = *folder_ / "elsewhere"});
  }

  static inline std::unique_ptr<TestFolder> folder_;
};

/// All vectors are there and sound; those of each protocol find their device.
TEST_F(Installed, runs_green_from_another_folder) {
  const Finished lint = run({"lint"});
  EXPECT_EQ(lint.code, 0) << lint.out.substr(0, 2000) << lint.err;
  EXPECT_EQ(lint.out, lint_of_the_vectors().out);
  const Finished finished =
      run({"run", "--profile", "xbc-h", "--filter", "*/examples/*:xgt_cnet/rss/*"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_GT(read_results(*folder_ / "elsewhere/fieldproof-out/results.ndjson").counts()["PASS"],
            100u);
  expect_reports(*folder_ / "elsewhere/fieldproof-out");
}

/// Not those of the source tree, which a developer's machine still has.
TEST_F(Installed, takes_its_own_vectors_and_profiles) {
  std::filesystem::copy(*folder_ / "usr", *folder_ / "own",
                        std::filesystem::copy_options::recursive);
  const std::string data = *folder_ / "own/share/fieldproof";
  const std::set<std::string> of_no_protocol{"citations", "errata", "statements", "wires"};
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(data + "/vectors"))
    if (entry.is_directory() && !of_no_protocol.contains(entry.path().filename()))
      folders.push_back(entry);
  for (const std::filesystem::path& folder : folders) std::filesystem::remove_all(folder);
  nlohmann::ordered_json vector = small_vector("own/vector");
  vector["statement"] = "xbl-c21a-en/7-10-number";
  vector.erase("source");
  folder_->write("own/share/fieldproof/vectors/xgt_cnet/test.json",
                 nlohmann::ordered_json::array({vector}).dump());
  std::filesystem::rename(data + "/profiles/xbc-h.json", data + "/profiles/own.json");
  const Finished list = run({"list"}, "own");
  EXPECT_EQ(list.code, 0) << list.err;
  EXPECT_THAT(list.out, HasSubstr("\n1 cases"));
  const Finished unknown = run({"run", "--profile", "xbc-h"}, "own");
  EXPECT_EQ(unknown.code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("own"));
  EXPECT_EQ(run({"run", "--profile", "own"}, "own").code, 0);
}

TEST_F(Installed, is_the_version_that_was_built) {
  EXPECT_EQ(run({"--version"}).out, run_tool({"--version"}).out);
}

}  // namespace
}  // namespace fieldproof::tool_tests
