// What run.sh and test.sh install, by release.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::Not;

/// The packages for a system that calls itself so.
std::vector<std::string> packages(const std::string& id, const std::string& version,
                                  const std::string& kinds = "build") {
  const TestFolder folder;
  const std::string file =
      folder.write("os-release", "ID=" + id + "\nVERSION_ID=\"" + version + "\"\n");
  const Finished finished =
      run_program({"bash", "-c", "set -uo pipefail; . ./setup.sh; packages_of " + kinds},
                  {.environment = {{"OS_RELEASE", file}}, .folder = FIELDPROOF_SOURCE_DIR});
  EXPECT_EQ(finished.code, 0) << finished.err;
  return text_lines(finished.out);
}

TEST(Packages, are_those_of_the_release) {
  EXPECT_THAT(packages("debian", "12"),
              AllOf(Contains("g++"), Contains("cmake"), Contains("libboost1.81-dev"),
                    Not(Contains("libboost1.74-dev")), Not(Contains("libboost1.83-dev"))));
  EXPECT_THAT(packages("ubuntu", "22.04"),
              AllOf(Contains("g++-12"), Contains("cmake"), Contains("libboost1.74-dev"),
                    Not(Contains("g++")), Not(Contains("libboost1.81-dev"))));
  EXPECT_THAT(packages("ubuntu", "24.04"), AllOf(Contains("g++"), Contains("libboost1.83-dev"),
                                                 Not(Contains("libboost1.81-dev"))));
}

TEST(Packages, of_a_release_that_nobody_named_are_those_of_debian_12) {
  EXPECT_EQ(packages("debian", "99"), packages("debian", "12"));
}

TEST(Packages, of_the_tests_are_more) {
  EXPECT_THAT(packages("debian", "12"), Not(Contains("socat")));
  EXPECT_THAT(packages("debian", "12", "build test"), AllOf(Contains("socat"), Contains("cmake")));
}

}  // namespace
}  // namespace fieldproof::tool_tests
