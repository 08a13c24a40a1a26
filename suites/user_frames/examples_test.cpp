// The example of a protocol of one's own, as a user runs it: with the built tool.
#include <gmock/gmock.h>

#include "suites/tool/tool.hpp"

namespace fieldproof::user_frames_suite {

using tool_tests::Finished;

namespace {

using testing::HasSubstr;

const std::string examples = FIELDPROOF_SOURCE_DIR "/suites/user_frames/examples/";
const std::string endpoint = "emulator:" + examples + "balance.json?protocol=user-frames";

Finished run(const tool_tests::TestFolder& folder, const std::string& vectors) {
  return tool_tests::run_tool(
      {"run", "--endpoint", endpoint, "--vectors", vectors, "--out", folder / "out"});
}

TEST(Balance, PassesItsOwnVectors) {
  const tool_tests::TestFolder folder;
  const Finished tool = run(folder, examples + "balance_vectors.json");
  EXPECT_EQ(tool.code, 0) << tool.out << tool.err;
  EXPECT_THAT(tool.out, HasSubstr("3  PASS"));
}

TEST(Balance, FailsWhereAVectorSaysOtherwise) {
  const tool_tests::TestFolder folder;
  std::string text = tool_tests::read_text(examples + "balance_vectors.json");
  const std::string held = R"("0250")";
  text.replace(text.find(held), held.size(), R"("0251")");
  const Finished tool = run(folder, folder.write("mine.json", text));
  EXPECT_EQ(tool.code, 1) << tool.out << tool.err;
  EXPECT_THAT(tool.out, HasSubstr("57 30 32 35 31 67 38 36"));
}

TEST(Balance, AMistakeInTheDefinitionIsNamed) {
  const tool_tests::TestFolder folder;
  std::string text = tool_tests::read_text(examples + "balance.json");
  text.replace(text.find("hex_to_ascii"), 12, "hex_to_asci");
  const std::string mine = folder.write("mine.json", text);
  const Finished tool =
      tool_tests::run_tool({"emulate", mine + "?protocol=user-frames", "--tcp", "127.0.0.1:0"});
  EXPECT_EQ(tool.code, 2) << tool.out;
  EXPECT_THAT(tool.err, HasSubstr("cannot read mine.json: group SAY, frame WEIGHT, body[1]: "
                                  "convert is 'hex_to_asci'; use hex_to_ascii"));
}

TEST(Frame, NamesTheSegmentsOfAShippedDefinition) {
  const Finished tool = tool_tests::run_tool(
      {"frame", "--protocol", "user-frames", "02 30 31 44 52 53 2C 30 32 2C 30 30 30 31 0D 0A"});
  EXPECT_EQ(tool.code, 0) << tool.err;
  EXPECT_THAT(tool.out, HasSubstr("start address"));
  EXPECT_THAT(tool.out, HasSubstr("DRS.test of px7"));
}

}  // namespace
}  // namespace fieldproof::user_frames_suite
