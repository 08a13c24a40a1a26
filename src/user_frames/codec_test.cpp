#include "src/user_frames/codec.hpp"

#include <gmock/gmock.h>

#include "src/user_frames/definition.hpp"

namespace fieldproof::user_frames {
namespace {

using State = FrameMatch::State;

constexpr const char* definition_text = R"j({
  "title": "frames of every kind",
  "groups": {
    "R": {"type": "receive", "head": [{"hex": "02"}], "tail": [{"check": "byte_sum"}, {"hex": "0D 0A"}],
          "frames": {"FIX": {"body": [{"text": "F"}, {"fixed": 2, "memory": "%MW0"}]},
                     "REST": {"body": [{"text": "V"}, {"variable": true, "memory": "%MW10"}]}}},
    "N": {"type": "receive", "tail": [{"check": "byte_sum"}], "frames": {"SUM": {"body": [{"text": "N"}, {"variable": true}]}}},
    "C": {"type": "receive", "tail": [{"hex": "03"}, {"check": "byte_sum", "start": "body.1", "end": "body"}],
          "frames": {"BODY": {"body": [{"text": "C"}, {"fixed": 1}, {"text": "D"}]}}},
    "S": {"type": "receive", "tail": [{"hex": "03"}, {"check": "byte_sum", "end": "body.1"}],
          "frames": {"SEGMENT": {"body": [{"text": "S"}, {"fixed": 1}, {"text": "E"}]}}},
    "T": {"type": "send", "head": [{"hex": "02"}], "tail": [{"check": "crc_16"}, {"hex": "0D"}],
          "frames": {"DATA": {"body": [{"variable": 4, "memory": "%MW0", "convert": "hex_to_ascii", "swap": 2}, {"text": "."}]}}}
  }
})j";

class Frames : public testing::Test {
 protected:
  const UserFrame& frame(std::string_view name) const { return *definition->find(name); }
  FrameMatch match(std::string_view name, std::string_view hex, bool ended = false) const {
    return match_frame(frame(name), *from_hex(hex), ended);
  }
  State state(std::string_view name, std::string_view hex, bool ended = false) const {
    return match(name, hex, ended).state;
  }
  bool holds(std::string_view name, std::string_view hex) const {
    const Bytes bytes = *from_hex(hex);
    return check_holds(frame(name), match_frame(frame(name), bytes), bytes);
  }

  Result<FrameDefinition> definition = parse_frame_definition(definition_text, "test.json");
  plc::PlcMemory memory{*plc::find_plc_model("xbc-h")};
};

TEST_F(Frames, AFixedFrameEndsWithItsLastByte) {
  EXPECT_EQ(state("R.FIX", ""), State::partial);
  EXPECT_EQ(state("R.FIX", "02 46 11 22 00 0D"), State::partial);
  EXPECT_EQ(state("R.FIX", "02 46 11 22 00 0D 0A"), State::complete);
  EXPECT_EQ(match("R.FIX", "02 46 11 22 00 0D 0A FF").length(), 7u);
}

TEST_F(Frames, EachConstantIsCompared) {
  EXPECT_EQ(state("R.FIX", "03"), State::no);
  EXPECT_EQ(state("R.FIX", "02 47"), State::no);
  EXPECT_EQ(state("R.FIX", "02 46 11 22 00 0D 0B"), State::no);
}

TEST_F(Frames, AVariableEndsWhereItsTailStands) {
  EXPECT_EQ(state("R.REST", "02 56 11 22 00 0D"), State::partial);
  const FrameMatch match = this->match("R.REST", "02 56 11 22 00 0D 0A 0D 0A");
  EXPECT_EQ(match.state, State::complete);
  EXPECT_THAT(match.ends, testing::ElementsAre(1, 2, 4, 5, 7));
  EXPECT_EQ(state("R.REST", "02 56 77 0D 0A"), State::complete);  // nothing in it
  EXPECT_EQ(state("R.REST", "02 56 0D 0A"), State::partial);      // no place for the check
}

TEST_F(Frames, AVariableWithoutATailEndsWithTheSilence) {
  EXPECT_EQ(state("N.SUM", "4E 01 02 51"), State::partial);
  EXPECT_EQ(match("N.SUM", "4E 01 02 51", true).length(), 4u);
  EXPECT_EQ(state("N.SUM", "4E", true), State::partial);
}

TEST_F(Frames, ACheckCoversWhatItsDefinitionSays) {
  EXPECT_TRUE(holds("R.FIX", "02 46 11 22 7B 0D 0A"));  // 02+46+11+22
  EXPECT_FALSE(holds("R.FIX", "02 46 11 22 7C 0D 0A"));
  EXPECT_TRUE(holds("C.BODY", "43 01 44 03 45"));     // 01+44
  EXPECT_TRUE(holds("S.SEGMENT", "53 01 45 03 54"));  // 53+01
}

TEST_F(Frames, AFrameIsBuiltFromMemory) {
  ASSERT_TRUE(plc::set_by_name(memory, "%MW0", "1234ABCD"));
  const Result<Bytes> bytes = build_frame(frame("T.DATA"), memory);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(to_hex(*bytes), "02 33 34 31 32 43 44 41 42 2E 06 9D 0D");
}

TEST_F(Frames, AllVariablesAreStoredOrNone) {
  const Bytes bytes = *from_hex("02 46 12 34 7B 0D 0A");
  EXPECT_EQ(store(frame("R.FIX"), match_frame(frame("R.FIX"), bytes), bytes, memory), Stored::yes);
  EXPECT_EQ(*plc::get_by_name(memory, "%MW0", 0), "1234");
}

TEST_F(Frames, MoreThanTheAreaHoldsIsNotStored) {
  const std::string small =
      R"j({"title": "t", "groups": {"G": {"type": "receive", "tail": [{"hex": "03"}],
    "frames": {"F": {"body": [{"fixed": 2, "memory": "%MW0"}, {"variable": true, "memory": "%MW1023"}]}}}}})j";
  Result<FrameDefinition> end = parse_frame_definition(small, "end.json");
  ASSERT_TRUE(end) << end.error().message;
  const UserFrame& one = end->frames.front();
  const Bytes bytes = *from_hex("11 22 33 44 55 03");
  EXPECT_EQ(store(one, match_frame(one, bytes), bytes, memory),
            Stored::beyond_area);  // 3 bytes from the last word on
  EXPECT_EQ(*plc::get_by_name(memory, "%MW0", 0), "0000");
}

}  // namespace
}  // namespace fieldproof::user_frames
