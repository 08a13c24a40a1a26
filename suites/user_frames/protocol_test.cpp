#include "suites/user_frames/protocol.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "suites/user_frames/definition_files.hpp"

namespace fieldproof::user_frames_suite {

using harness::Field;

namespace {

using testing::Contains;
using testing::HasSubstr;

const std::string balance = FIELDPROOF_SOURCE_DIR "/suites/user_frames/examples/balance.json";
const Bytes drs_request = to_bytes(
    "\x02"
    "01DRS,02,0001\r\n");
const Bytes drs_reply = to_bytes(
    "\x02"
    "01DRS,OK,0016,02D6\r\n");

std::string text_of(const std::vector<Field>& fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? "no such field" : found->text;
}
std::string problem_of(const std::vector<Field>& fields, std::string_view name) {
  const auto found = std::ranges::find(fields, name, &Field::name);
  return found == fields.end() ? "no such field" : found->problem;
}

TEST(UserFramesProtocol, ModelsAreTheShippedDefinitionsAndPaths) {
  EXPECT_THAT(protocol().models(), testing::IsSupersetOf({"px7", "px7_controller", "xgt_write"}));
  EXPECT_TRUE(protocol().has_model("px7"));
  EXPECT_TRUE(protocol().has_model("my/own.json"));
  EXPECT_TRUE(protocol().has_model("xbc-h")) << "with a definition in its configuration";
  EXPECT_FALSE(protocol().has_model("xbc-x"));
}

TEST(UserFramesProtocol, EveryShippedDefinitionMakesADevice) {
  for (const std::string& model : protocol().models()) {
    const auto device = protocol().make_device(model, nlohmann::json::object());
    EXPECT_TRUE(device) << device.error().message;
  }
  EXPECT_TRUE(protocol().make_device(balance, nlohmann::json::object()));
}

TEST(UserFramesProtocol, ADefinitionIsReadOnceByPortsInThreads) {
  const auto path = [](int i) {
    return FIELDPROOF_SOURCE_DIR "/suites/user_frames/examples/" + std::string(i, '/') +
           "balance.json";
  };
  constexpr int paths = 40, threads = 4;
  std::array<std::array<const harness::Protocol*, paths>, threads> read{};
  std::vector<std::thread> ports;
  for (auto& own : read)
    ports.emplace_back([&own, path] {
      for (int i = 0; i < paths; ++i) own[i] = &protocol_of(path(i));
    });
  for (std::thread& port : ports) port.join();
  for (const auto& own : read) EXPECT_EQ(own, read[0]);
  EXPECT_NE(read[0][0], &protocol());
  EXPECT_NE(read[0][0], read[0][1]);
}

TEST(UserFramesProtocol, AnUnknownModelIsAnErrorThatNamesTheNearest) {
  const auto named = protocol().make_device("px8", nlohmann::json::object());
  ASSERT_FALSE(named);
  EXPECT_THAT(named.error().message, HasSubstr("did you mean 'px7'?"));
  const auto path = protocol().make_device("nowhere/mine.json", nlohmann::json::object());
  ASSERT_FALSE(path);
  EXPECT_THAT(path.error().message,
              HasSubstr("cannot read nowhere/mine.json: no such file or directory"));
  const auto folder = protocol().make_device("/.json", nlohmann::json::object());
  EXPECT_FALSE(folder);
}

TEST(UserFramesProtocol, ExplainsAFrameOfAnyDefinition) {
  const std::vector<Field> fields = protocol().explain(drs_reply);
  EXPECT_EQ(text_of(fields, "present value"), "'0016'");
  EXPECT_EQ(text_of(fields, "frame"), "DRS_RECE.RECE_DRS of px7");
  EXPECT_TRUE(
      std::ranges::all_of(fields, [](const Field& field) { return field.problem.empty(); }));
}

TEST(UserFramesProtocol, SaysWhatIsWrongWithAFrame) {
  const std::vector<Field> sum =
      protocol().explain(*from_hex("15 30 31 77 53 42 31 31 33 32 03 30 30"));
  EXPECT_EQ(problem_of(sum, "BCC"), "expected '4C' (byte_sum of NAK to ETX)");
  const harness::Protocol& px7 = protocol_of("px7");
  EXPECT_EQ(problem_of(px7.explain(to_bytes("\x02"
                                            "01DRS,OK,0016,02")),
                       "rest"),
            "setting value is cut off");
  EXPECT_EQ(problem_of(px7.explain(to_bytes("\x02"
                                            "01DRX")),
                       "rest"),
            "expected command: 'DRS'");
  EXPECT_EQ(problem_of(px7.explain(to_bytes("\x02"
                                            "01DRS,02,0001\r\nX")),
                       "rest"),
            "behind the end of the frame");
  EXPECT_EQ(problem_of(px7.explain(to_bytes("W\r\n")), "frame"),
            "no definition has a frame that begins like this");
  EXPECT_EQ(px7.explain({}).size(), 1u);
}

/// Offsets and sizes must stay inside whatever comes: `frame` prints each part.
TEST(UserFramesProtocol, EveryPartLiesInsideTheFrame) {
  for (std::size_t size = 0; size <= drs_reply.size(); ++size)
    for (const Field& field : protocol().explain(ByteView(drs_reply).first(size)))
      EXPECT_LE(field.offset + field.size, size) << field.name;
}

TEST(UserFramesProtocol, AFrameEndsWhereItsDefinitionSays) {
  const harness::Protocol& px7 = protocol_of("px7");
  EXPECT_EQ(px7.frame_length(drs_request), drs_request.size());
  EXPECT_EQ(px7.frame_length(ByteView(drs_request).first(15)), std::nullopt);
  Bytes both = drs_request;
  both.insert(both.end(), drs_reply.begin(), drs_reply.end());
  EXPECT_EQ(px7.frame_length(both), drs_request.size());
}

TEST(UserFramesProtocol, OneModelHasItsProbe) {
  const harness::Protocol& controller = protocol_of("px7_controller");
  EXPECT_EQ(controller.probe(1, {}), drs_request);
  EXPECT_TRUE(controller.is_reply_to_probe(drs_request, drs_reply));
  EXPECT_FALSE(controller.is_reply_to_probe(drs_request, drs_request));
  EXPECT_TRUE(controller.probe(1, drs_request).empty());  // its reply could be the tested frame's
  EXPECT_TRUE(protocol().probe(1, {}).empty());
  EXPECT_TRUE(protocol_of("px7").probe(1, {}).empty());
  EXPECT_EQ(protocol_of(balance).probe(1, {}), to_bytes("W\r\n"));
}

TEST(UserFramesProtocol, AModelThatCannotBeReadHasTheFramesOfAll) {
  EXPECT_EQ(&protocol_of("px8"), &protocol());
}

TEST(UserFramesProtocol, TheFenceKnowsWhatAFrameStores) {
  const auto written = protocol_of("px7").written_by(drs_reply);
  ASSERT_EQ(written.size(), 2u);
  EXPECT_EQ(written[0].area, "M");
  EXPECT_EQ(written[0].first_word, 200u);
  EXPECT_EQ(written[0].last_word, 201u);
  EXPECT_EQ(written[1].address, "%MW210");
  const auto tare = protocol_of(balance).written_by(to_bytes("T0012\r\n"));
  ASSERT_EQ(tare.size(), 1u);
  EXPECT_EQ(tare[0].first_word, 101u);
  EXPECT_EQ(tare[0].last_word, 101u);  // four digits are one word
  EXPECT_TRUE(protocol_of("px7_controller").written_by(drs_request).empty());
}

TEST(UserFramesProtocol, WhatNobodyCanTellIsArea) {
  EXPECT_EQ(protocol_of("px7").written_by(to_bytes("W\r\n")).at(0).area, "?");
  EXPECT_EQ(protocol().written_by(drs_request).at(0).area,
            "?");  // whose frames are on the other side is not known
}

TEST(UserFramesProtocol, ThereIsNoWayToMemoryThroughFrames) {
  EXPECT_THAT(protocol().write_requests(1, "%MW100", "1234").error().message,
              HasSubstr("no request that reads or writes %MW100"));
  EXPECT_FALSE(protocol().read_requests(1, "%MW100", 4));
  EXPECT_FALSE(protocol().write_reply({}));
  EXPECT_FALSE(protocol().read_reply({}));
}

TEST(UserFramesProtocol, FactsAreCheckedAgainstTheTables) {
  using nlohmann::json;
  EXPECT_TRUE(protocol().check_fact(json{{"limit", "frame_bytes"}, {"value", 1024}}));
  EXPECT_THAT(protocol().check_fact(json{{"limit", "variables"}, {"value", 5}}).error().message,
              HasSubstr("variables are limited to 4, not 5"));
  EXPECT_FALSE(protocol().check_fact(json{{"limit", "frames"}, {"value", 4}}));
  EXPECT_TRUE(protocol().check_fact(json{{"check", "lgis_crc"}, {"bytes", 0}}));
  EXPECT_FALSE(protocol().check_fact(json{{"check", "crc_16"}, {"bytes", 1}}));
  const json definition = json::parse(
      R"({"title": "t", "groups": {"G": {"type": "send", "frames": {"F": {"body": [{"text": "12345678901"}]}}}}})");
  EXPECT_TRUE(protocol().check_fact(json{{"definition", definition}, {"refused", "11 bytes"}}));
  EXPECT_THAT(protocol().check_fact(json{{"definition", definition}}).error().message,
              HasSubstr("11 bytes"));
  EXPECT_FALSE(protocol().check_fact(json{{"definition", definition}, {"refused", "12 bytes"}}));
  EXPECT_FALSE(protocol().check_fact(json::object()));
}

}  // namespace
}  // namespace fieldproof::user_frames_suite
