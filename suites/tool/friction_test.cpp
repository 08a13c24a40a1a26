// What used to cost a newcomer minutes.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::string emulated_plc = "exec:" FIELDPROOF_TOOL " emulate xbc-h --pty {tty}";

/// Speed and format cannot be seen behind a pty, whatever a profile declares: one reason.
TEST(Friction, a_pty_has_no_line_and_says_so_once) {
  const TestFolder folder;
  nlohmann::ordered_json slow = small_vector("f/slow"), odd = small_vector("f/odd");
  slow["given"]["config"]["line"] = "9600-8N1";
  odd["given"]["config"]["bench_line"] = "9600-8O1";
  const Finished finished =
      run_tool({"run", "--endpoint", emulated_plc, "--profile", "xbc-h", "--vectors",
                write_vectors(folder, {slow, odd}), "--out", folder / "out"});
  const Results results = read_results(folder / "out/results.ndjson");
  std::set<std::string> reasons;
  for (const nlohmann::json& one : results.cases) {
    EXPECT_EQ(one.at("verdict"), "INCONCLUSIVE");
    reasons.insert(one.at("message"));
  }
  EXPECT_THAT(reasons,
              ElementsAre("is about speed and character format, which a pty or socket does "
                          "not carry"));
  EXPECT_EQ(finished.code, 4);
}

TEST(Friction, a_run_that_judged_nothing_says_why) {
  const TestFolder folder;
  const Finished finished = run_tool({"run", "--endpoint", "emulator:xbc-h?protocol=modbus-rtu",
                                      "--filter", "xgt_cnet/rss/*", "--out", folder / "out"});
  EXPECT_EQ(finished.code, 4) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("\nnothing was judged:\n"));
  EXPECT_THAT(finished.out,
              HasSubstr(" cases: xgt-cnet is not what this endpoint speaks (modbus-rtu)"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
