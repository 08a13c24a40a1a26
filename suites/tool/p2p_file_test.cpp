// `emulate --p2p`: the module as client behind a pty.
#include <gmock/gmock.h>

#include "suites/tool/tool.hpp"

namespace fieldproof::tool_tests {
namespace {

using testing::HasSubstr;

TEST(EmulateP2p, AsksByItself) {
  const TestFolder folder;
  const std::string file = folder.write(
      "p2p.json",
      R"({"p2p": {"blocks": [{"flag": "F90", "read": "%MW100", "save": "%MW200", "station": 2}]}})");
  Process client(
      {FIELDPROOF_TOOL, "emulate", "xbc-h", "--p2p", file, "--pty", folder / "line", "-v"});
  EXPECT_TRUE(client.wait_for("ENQ '02rSS0106%MW100' EOT"));
}

TEST(EmulateP2p, ErrorsNameFileAndKey) {
  const TestFolder folder;
  const auto refused = [&folder](const std::string& text) {
    const Finished tool = run_tool(
        {"emulate", "xbc-h", "--p2p", folder.write("p2p.json", text), "--pty", folder / "line"});
    EXPECT_EQ(tool.code, 2) << text;
    EXPECT_THAT(tool.err, HasSubstr(folder / "p2p.json")) << text;
    return tool.err;
  };
  EXPECT_THAT(refused("{\"p2p\": [}"), HasSubstr("it is no JSON: "));
  EXPECT_THAT(refused("{}"), HasSubstr("there is no \"p2p\""));
  EXPECT_THAT(refused("[]"), HasSubstr("it is no object"));
  EXPECT_THAT(refused(R"({"role": "server", "p2p": {}})"),
              HasSubstr("role is \"server\"; P2P is of role client"));
  EXPECT_THAT(refused(R"({"time_out": 51, "p2p": {}})"),
              HasSubstr("p2p.json, as xgt-cnet (MODEL?protocol=... for another): cannot read the "
                        "P2P client's configuration: time_out is 51"));
  EXPECT_THAT(refused(R"({"p2p": {"blocks": [{"flag": "F90", "read": "%MW1", "save": "%FW1"}]}})"),
              HasSubstr("p2p.json, as xgt-cnet (MODEL?protocol=... for another): cannot read P2P "
                        "block 0: save '%FW1': F is read only"));
  const Finished absent = run_tool({"emulate", "xbc-h", "--p2p", folder / "absent.json"});
  EXPECT_EQ(absent.code, 2);
  EXPECT_THAT(absent.err, HasSubstr("absent.json: no such file"));
}

}  // namespace
}  // namespace fieldproof::tool_tests
