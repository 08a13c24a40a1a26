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
              HasSubstr("  SKIP          xgt-cnet is not what this endpoint speaks (modbus-rtu)"));
}

/// Nor is it left to the reports why a part was not judged.
TEST(Friction, a_run_says_why_the_rest_was_not_judged) {
  const TestFolder folder;
  const Finished finished =
      run_tool({"run", "--endpoint", emulated_plc, "--profile", "xbc-h", "--filter",
                "xgt_cnet/status_by_service/power_off_clears:xgt_cnet/line/delay/d10:"
                "xgt_cnet/channels/*:xgt_cnet/rss/two_words/*:modbus_rtu/station/*",
                "--role", "server", "--out", folder / "out"});
  EXPECT_EQ(finished.code, 0) << finished.out << finished.err;
  EXPECT_THAT(finished.out, HasSubstr("\nnot judged, and why, or what it takes:\n"));
  EXPECT_THAT(finished.out,
              HasSubstr("BLOCKED       a way to what no command reads: --control COMMAND, or a "
                        "look in XG5000\n"));
  EXPECT_THAT(finished.out,
              HasSubstr("SKIP          modbus-rtu is not what this endpoint speaks (xgt-cnet)\n"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
