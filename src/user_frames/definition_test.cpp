#include "src/user_frames/definition.hpp"

#include <gmock/gmock.h>

namespace fieldproof::user_frames {
namespace {

using testing::HasSubstr;

/// A definition of one group.
std::string group(std::string_view content) {
  return R"({"title": "t", "groups": {"G": )" + std::string(content) + "}}";
}
std::string receive(std::string_view body, std::string_view tail = "",
                    std::string_view head = R"({"hex": "02"})") {
  return group(R"({"type": "receive", "head": [)" + std::string(head) + R"(], "tail": [)" +
               std::string(tail) + R"(], "frames": {"F": {"body": [)" + std::string(body) + "]}}}");
}
std::string send(std::string_view body, std::string_view tail = "") {
  return group(R"({"type": "send", "tail": [)" + std::string(tail) +
               R"(], "frames": {"F": {"body": [)" + std::string(body) + "]}}}");
}
std::string with_check(std::string_view check, std::string_view tail = R"({"hex": "03"}, )") {
  return receive(R"({"text": "A"}, {"fixed": 2})", std::string(tail) + std::string(check));
}

std::string error_of(const std::string& text) {
  const Result<FrameDefinition> definition = parse_frame_definition(text, "mine.json");
  return definition ? "accepted" : definition.error().message;
}
UserFrame frame_of(const std::string& text) {
  const Result<FrameDefinition> definition = parse_frame_definition(text, "mine.json");
  EXPECT_TRUE(definition) << definition.error().message;
  return definition ? definition->frames.front() : UserFrame{};
}

TEST(FrameDefinition, HoldsHeadBodyAndTailOfEachFrame) {
  const UserFrame frame =
      frame_of(receive(R"({"text": "DRS", "name": "command"}, {"fixed": 4, "memory": "%MW200"})",
                       R"({"hex": "0D 0A"})"));
  EXPECT_EQ(frame.name, "G.F");
  EXPECT_FALSE(frame.sent);
  ASSERT_EQ(frame.segments.size(), 4u);
  EXPECT_EQ(frame.segments[0].name, "head 0");
  EXPECT_EQ(frame.segments[1].name, "command");
  EXPECT_EQ(frame.segments[2].size, 4u);
  EXPECT_EQ(frame.segments[2].address, "%MW200");
  EXPECT_EQ(to_hex(frame.segments[3].bytes), "0D 0A");
}

TEST(FrameDefinition, FramesKeepTheOrderOfTheFile) {
  const auto definition = parse_frame_definition(
      group(
          R"({"type": "send", "frames": {"Z": {"body": [{"text": "z"}]}, "A": {"body": [{"text": "a"}]}}})"),
      "mine.json");
  ASSERT_TRUE(definition);
  EXPECT_EQ(definition->frames.front().name, "G.Z");
}

TEST(FrameDefinition, SizesAreOfMemoryWhenSentAndOfTheFrameWhenReceived) {
  EXPECT_EQ(frame_of(send(R"({"variable": 8, "memory": "%MW100", "convert": "hex_to_ascii"})"))
                .segments[0]
                .size,
            16u);
  EXPECT_EQ(frame_of(send(R"({"variable": 8, "memory": "%MW100", "convert": "ascii_to_hex"})"))
                .segments[0]
                .size,
            4u);
  EXPECT_EQ(frame_of(receive(R"({"fixed": 8, "memory": "%MW100", "convert": "ascii_to_hex"})"))
                .segments[1]
                .size,
            8u);
}

TEST(FrameDefinition, ACheckCoversAllBeforeItUnlessToldOtherwise) {
  const Segment all = frame_of(with_check(R"({"check": "crc_16"})")).segments.back();
  EXPECT_EQ(all.first, 0u);
  EXPECT_EQ(all.last, 3u);
  EXPECT_EQ(all.options.start, 0xFFFF);
  const Segment part =
      frame_of(
          with_check(R"({"check": "byte_sum", "start": "body.0", "end": "body.1", "ascii": true})"))
          .segments.back();
  EXPECT_EQ(part.first, 1u);
  EXPECT_EQ(part.last, 2u);
  EXPECT_EQ(part.size, 2u);
  EXPECT_EQ(part.options.start, 0);
  EXPECT_EQ(frame_of(with_check(R"({"check": "byte_xor", "initial": "00", "end": "body"})"))
                .segments.back()
                .options.start,
            0);
  EXPECT_EQ(frame_of(with_check(R"({"check": "byte_sum", "initial": "FF"})"))
                .segments.back()
                .options.start,
            0xFF);
}

TEST(FrameDefinition, DedicatedChecksCoverWhatTheirProtocolSays) {
  const UserFrame df1 =
      frame_of(receive(R"({"text": "A"}, {"text": "B"})",
                       R"({"hex": "10 03"}, {"check": "dle_ab"})", R"({"hex": "10 02"})"));
  EXPECT_EQ(df1.segments.back().first, 1u);
  EXPECT_EQ(df1.segments.back().last, 2u);
  const UserFrame siemens =
      frame_of(receive(R"({"text": "A"})", R"({"hex": "10 03"}, {"check": "dle_siemens"})"));
  EXPECT_EQ(siemens.segments.back().first, 1u);
  EXPECT_EQ(siemens.segments.back().last, 2u);
}

TEST(FrameDefinition, AnswersAndProbesNameFrames) {
  const std::string text = R"j({"title": "t", "groups": {
    "IN": {"type": "receive", "frames": {"ASK": {"body": [{"text": "W"}], "answer": "OUT.SAY"}}},
    "OUT": {"type": "send", "frames": {"SAY": {"body": [{"text": "7"}]}}}}, "probe": {"send": "IN.ASK", "reply": "OUT.SAY"}})j";
  const auto definition = parse_frame_definition(text, "mine.json");
  ASSERT_TRUE(definition) << definition.error().message;
  EXPECT_EQ(definition->find("IN.ASK")->answer, "OUT.SAY");
  EXPECT_EQ(definition->probe, "IN.ASK");
}

/// A definition that is wrong, and what its error says.
struct Wrong {
  std::string name, text, says;
};
void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

class WrongDefinition : public testing::TestWithParam<Wrong> {};

TEST_P(WrongDefinition, IsRefused) {
  EXPECT_THAT(error_of(GetParam().text), HasSubstr("cannot read mine.json"));
  EXPECT_THAT(error_of(GetParam().text), HasSubstr(GetParam().says));
}

const std::string two =
    R"j({"title": "t", "groups": {"I": {"type": "receive", "frames": {"A": {"body": [{"fixed": 1}], "answer": "O.B"}}},
  "O": {"type": "send", "frames": {"B": {"body": [{"text": "x"}]}}}})j";
std::string probe(std::string_view send, std::string_view reply) {
  return two + R"(, "probe": {"send": ")" + std::string(send) + R"(", "reply": ")" +
         std::string(reply) + R"("}})";
}
std::string replaced(std::string text, std::string_view from, std::string_view to) {
  return text.replace(text.find(from), from.size(), to);
}

INSTANTIATE_TEST_SUITE_P(
    Each, WrongDefinition,
    testing::Values(
        Wrong{"no_json", "{", "it is no JSON"},
        Wrong{
            "key_twice",
            group(
                R"({"type": "send", "frames": {"F": {"body": [{"text": "a"}]}, "F": {"body": [{"text": "b"}]}}})"),
            "'F' stands twice"},
        Wrong{"no_title", R"({"groups": {}})", "there is no title"},
        Wrong{"no_groups", R"({"title": "t"})", "there are no groups"},
        Wrong{"unknown_key", R"({"titel": "t"})",
              "there is no key 'titel'; the keys are groups, note, plc, probe, title; did you mean "
              "'title'?"},
        Wrong{"unknown_plc", R"({"title": "t", "plc": "xgk", "groups": {"G": {}}})",
              "plc is 'xgk'; use one of"},
        Wrong{"no_type", group(R"({"frames": {}})"), "group G: type is ''; use send or receive"},
        Wrong{"no_frames", group(R"({"type": "send"})"), "group G: there are no frames"},
        Wrong{"no_body", group(R"({"type": "send", "frames": {"F": {}}})"),
              "group G, frame F: there is no body"},
        Wrong{"dot_in_name",
              group(R"({"type": "send", "frames": {"F.1": {"body": [{"text": "a"}]}}})"),
              "the name 'F.1'"},
        Wrong{"unknown_segment_key", receive(R"({"txet": "A"})"),
              "group G, frame F, body[0]: there is no key 'txet'"},
        Wrong{"no_form", receive(R"({"name": "A"})"),
              "body[0]: it has none of hex, text, fixed, variable and check"},
        Wrong{"two_forms", receive(R"({"hex": "41", "text": "A"})"), "it has hex and text"},
        Wrong{"foreign_key", receive(R"({"hex": "41", "swap": 2})"),
              "there is no key 'swap'; the keys are hex, name"},
        Wrong{"bad_hex", receive(R"({"hex": "4"})"), "hex is '4', which are no hex bytes"},
        Wrong{"long_constant", receive(R"({"text": "12345678901"})"),
              "the constant has 11 bytes; a segment holds 1 to 10"},
        Wrong{"empty_constant", receive(R"({"text": ""})"), "the constant has 0 bytes"},
        Wrong{"not_ascii", receive(R"({"text": "é"})"), "not ASCII"},
        Wrong{"variable_in_head", receive(R"({"text": "A"})", "", R"({"fixed": 2})"),
              "head[0]: fixed stands in a head"},
        Wrong{"check_in_body", receive(R"({"check": "byte_sum"})"), "a check stands in a body"},
        Wrong{"fixed_sent", send(R"({"fixed": 2, "memory": "%MW0"})"),
              "fixed is for receive groups"},
        Wrong{"sent_without_memory", send(R"({"variable": 2})"), "there is no memory"},
        Wrong{"sent_without_size", send(R"({"variable": true, "memory": "%MW0"})"),
              "variable is true, which is not a number of bytes"},
        Wrong{"received_with_size", receive(R"({"variable": 2})"),
              "a received variable has no size"},
        Wrong{"size_zero", receive(R"({"fixed": 0})"),
              "fixed is 0, which is not a number of bytes from 1 to 1024"},
        Wrong{"open_size_is_last", send(R"({"variable": true, "memory": true}, {"text": "A"})"),
              "a segment follows body[0]"},
        Wrong{"memory_is_a_number", send(R"({"variable": 2, "memory": 1})"),
              "memory is 1, which is no text"},
        Wrong{"bad_address", receive(R"({"fixed": 2, "memory": "%QW0.0"})"),
              "memory '%QW0.0' is wrong on xbc-h"},
        Wrong{"bit_address", receive(R"({"fixed": 2, "memory": "%MX00"})"), "is a bit"},
        Wrong{"read_only", receive(R"({"fixed": 2, "memory": "%FW0"})"), "'%FW0' is read only"},
        Wrong{"beyond_the_area", receive(R"({"fixed": 4, "memory": "%MW1023"})"),
              "4 bytes from %MW1023 on: the area of xbc-h ends before"},
        Wrong{"odd_digits", receive(R"({"fixed": 3, "convert": "ascii_to_hex"})"),
              "3 bytes are no pairs of hex digits"},
        Wrong{"swap_3", receive(R"({"fixed": 3, "swap": 3})"), "swap is 3; use 2, 4 or 8"},
        Wrong{"swap_of_part", receive(R"({"fixed": 6, "swap": 4})"),
              "6 bytes of memory are no whole groups of 4"},
        Wrong{"unknown_conversion", receive(R"({"fixed": 2, "convert": "hex"})"),
              "convert is 'hex'"},
        Wrong{"five_variables",
              receive(R"({"fixed": 1}, {"fixed": 1}, {"fixed": 1}, {"fixed": 1}, {"fixed": 1})"),
              "the body has 5 variables; it may have 4"},
        Wrong{"too_long", receive(R"({"fixed": 1024})"),
              "the frame has 1025 bytes; it may have 1024"},
        Wrong{"behind_the_variable",
              receive(R"({"variable": true}, {"text": "A"})", R"({"hex": "03"})"),
              "a segment follows body[0]"},
        Wrong{"two_variables",
              receive(R"({"variable": true}, {"variable": true})", R"({"hex": "03"})"),
              "a segment follows body[0]"},
        Wrong{"variable_alone",
              group(R"({"type": "receive", "frames": {"F": {"body": [{"variable": true}]}}})"),
              "needs a head or a tail"},
        Wrong{"unknown_check", with_check(R"({"check": "byte_smu"})"),
              "there is no check 'byte_smu'; the checks are byte_sum, word_sum"},
        Wrong{"lgis_crc", with_check(R"({"check": "lgis_crc"})"),
              "check 'lgis_crc': neither the manuals nor a source"},
        Wrong{"two_checks", with_check(R"({"check": "byte_sum"}, {"check": "byte_sum"})"),
              "the tail has two checks"},
        Wrong{"start_nowhere", with_check(R"({"check": "byte_sum", "start": "body.2"})"),
              "start is 'body.2'; there is no such segment"},
        Wrong{"end_nowhere", with_check(R"({"check": "byte_sum", "end": "bodi"})"),
              "end is 'bodi'"},
        Wrong{"covers_itself", with_check(R"({"check": "byte_sum", "end": "tail"})"),
              "the check would cover itself"},
        Wrong{"ends_before_start",
              with_check(R"({"check": "byte_sum", "start": "body.1", "end": "body.0"})"),
              "ends before it starts"},
        Wrong{"initial_1", with_check(R"({"check": "byte_sum", "initial": "1"})"),
              "initial is '1'; use 00 or FF"},
        Wrong{"order_of_one_byte", with_check(R"({"check": "byte_sum", "order": "low_first"})"),
              "is one byte; remove 'order'"},
        Wrong{"ascii_text", with_check(R"({"check": "byte_sum", "ascii": "yes"})"),
              "ascii is \"yes\""},
        Wrong{"dedicated_range", with_check(R"({"check": "dle_siemens", "start": "body.0"})"),
              "remove 'start'"},
        Wrong{"dle_without_etx", with_check(R"({"check": "dle_siemens"})"),
              "begin the tail with hex 10 03"},
        Wrong{"dle_without_stx", with_check(R"({"check": "dle_ab"})", R"({"hex": "10 03"}, )"),
              "end the head with hex 10 02"},
        Wrong{"answer_nowhere", replaced(two, "O.B", "O.C") + "}",
              "frame I.A: answer names 'O.C'; there is no such frame"},
        Wrong{"answer_received", replaced(two, "O.B", "I.A") + "}",
              "answer names I.A, which is received; name a frame of a send group"},
        Wrong{
            "answer_to_sent",
            group(
                R"({"type": "send", "frames": {"F": {"body": [{"text": "a"}], "answer": "G.F"}}})"),
            "a sent frame has no answer"},
        Wrong{"probe_open", probe("I.A", "O.B"), "probe: send names I.A, which has variables"},
        Wrong{"probe_sent", probe("O.B", "O.B"), "probe: send names O.B, which is sent"}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace fieldproof::user_frames
