// What the link can show is measured before the first case, and nothing is judged below it.
#include <gmock/gmock.h>

#include "suites/tool/tool_files.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;
using testing::Not;

class Floor : public testing::Test {
 protected:
  Finished run(const std::string& endpoint, const std::vector<std::string>& more = {}) {
    nlohmann::ordered_json brief = small_vector("v/brief");
    brief["steps"][1]["within"] = "10ms";
    std::vector<std::string> command{"run",
                                     "--endpoint",
                                     endpoint,
                                     "--vectors",
                                     write_vectors(folder_, {small_vector("v/usual"), brief}),
                                     "--out",
                                     out_};
    command.insert(command.end(), more.begin(), more.end());
    return run_tool(command);
  }
  Results results() { return read_results(out_ + "/results.ndjson"); }

  TestFolder folder_;
  std::string out_ = folder_ / "out";
};

TEST_F(Floor, IsMeasuredOnRealTime) {
  const Finished finished = run("pty:xbc-h");
  EXPECT_THAT(finished.out, HasSubstr("answers by the device, its own time included: min "));
  const Results all = results();
  EXPECT_THAT(all.run["properties"]["floor"], HasSubstr("20 answers by the device"));
  EXPECT_EQ(all.verdict("xgt_cnet/v/usual"), "PASS");
  EXPECT_EQ(all.verdict("xgt_cnet/v/brief"), "INCONCLUSIVE");
  EXPECT_GE(all.of("xgt_cnet/v/brief")["recording"]["timing_floor_ms"], 20);
  Junit junit;
  read_junit(out_ + "/junit.xml", junit);
  EXPECT_TRUE(junit.document.select_node("//property[@name='floor']"));
}

TEST_F(Floor, SimulatedTimeHasNone) {
  EXPECT_THAT(run("emulator:xbc-h").out, Not(HasSubstr("floor=")));
  EXPECT_EQ(results().verdict("xgt_cnet/v/brief"), "PASS");
}

TEST_F(Floor, IsTakenFromALoop) {
  EXPECT_THAT(run("emulator:xbc-h", {"--loop", "pty:xbc-h"}).out,
              HasSubstr("answers over the loop"));
  EXPECT_THAT(results().run["properties"]["floor"], HasSubstr("over the loop: min "));
  EXPECT_THAT(run("pty:xbc-h", {"--loop", "emulator:xbc-h"}).err,
              HasSubstr("--loop: simulated time has no floor"));
}

TEST_F(Floor, IsGivenByHand) {
  EXPECT_THAT(run("pty:xbc-h", {"--floor", "2ms"}).out, HasSubstr("floor=2.0 ms (given by hand)"));
  EXPECT_EQ(results().of("xgt_cnet/v/brief")["recording"]["timing_floor_ms"], 2);
  EXPECT_THAT(run("emulator:xbc-h", {"--floor", "30ms"}).out,
              HasSubstr("floor=30.0 ms (given by hand)"));
  EXPECT_EQ(run("emulator:xbc-h", {"--floor", "soon"}).code, 2);
  EXPECT_EQ(run("emulator:xbc-h", {"--floor", "2"}).code, 2) << "without a unit";
}

}  // namespace
}  // namespace fieldproof::tool_tests
