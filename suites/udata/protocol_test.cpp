#include "suites/udata/protocol.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::udata_suite {
namespace {

using testing::HasSubstr;

TEST(UdataProtocol, EveryModelMakesADevice) {
  for (const std::string& model : protocol().models()) {
    const auto device = protocol().make_device(model, nlohmann::json::object());
    EXPECT_TRUE(device) << device.error().message;
  }
  const auto none = protocol().make_device("xbm-s", nlohmann::json::object());
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr("use xbc-h or xec-h"));
}

TEST(UdataProtocol, DataHasNoEndOfItsOwn) {
  EXPECT_FALSE(protocol().frame_length(to_bytes("OK\r\n")));
  EXPECT_TRUE(protocol().probe(1, {}).empty());
}

TEST(UdataProtocol, ShowsTheData) {
  const std::vector<harness::Field> fields = protocol().explain(to_bytes("OK"));
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0].text, "4F 4B");
  EXPECT_EQ(fields[0].problem, "");
  EXPECT_EQ(protocol().monitor_result(to_bytes("OK"), true, false), plc::user_definition_frame);
  EXPECT_EQ(protocol().explain(Bytes(1025, 0x41))[0].problem, "more than 1024 bytes");
}

TEST(UdataProtocol, WhatIsSentMayWriteAnything) {
  ASSERT_EQ(protocol().written_by(to_bytes("AT\r")).size(), 1u);
  EXPECT_EQ(protocol().written_by(to_bytes("AT\r"))[0].area, "?");
}

}  // namespace
}  // namespace fieldproof::udata_suite
