#include "harness/cli/ci_job.hpp"

#include <fmt/format.h>

namespace fieldproof::cli {

namespace {

constexpr const char* where_the_tool_is =
    "# fieldproof is a submodule here; where its package is installed, the command is "
    "fieldproof.\n";

std::string github(const std::string& arguments, bool own_runner) {
  return fmt::format(
      R"({}on: [push, pull_request]
permissions: {{contents: read, checks: write}}
jobs:
  conformance:
    runs-on: {}
    steps:
      - uses: actions/checkout@v4
        with: {{submodules: recursive}}
      - run: fieldproof/run.sh run {}
      - uses: actions/upload-artifact@v4
        if: always()
        with: {{name: conformance, path: fieldproof-out/}}
      - uses: mikepenz/action-junit-report@v6
        if: always()
        with: {{report_paths: fieldproof-out/junit.xml}}
)",
      where_the_tool_is,
      own_runner ? "[self-hosted, bench]" : "ubuntu-latest\n    container: debian:12", arguments);
}

std::string gitlab(const std::string& arguments, bool own_runner) {
  return fmt::format(R"({}conformance:
  {}
  variables: {{GIT_SUBMODULE_STRATEGY: recursive}}
  script: fieldproof/run.sh run {}
  artifacts:
    when: always
    paths: [fieldproof-out/]
    reports:
      junit: fieldproof-out/junit.xml
)",
                     where_the_tool_is, own_runner ? "tags: [bench]" : "image: debian:12",
                     arguments);
}

}  // namespace

CiJob ci_job(const std::string& system, const std::string& arguments, bool own_runner) {
  if (system == "github")
    return {".github/workflows/conformance.yml", github(arguments, own_runner)};
  return {".gitlab-ci.yml", gitlab(arguments, own_runner)};
}

}  // namespace fieldproof::cli
