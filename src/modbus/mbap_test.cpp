#include "src/modbus/mbap.hpp"

#include <gtest/gtest.h>

#include "src/modbus/mbap_receiver.hpp"
#include "src/modbus/test_frames.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {
namespace {

using plc::test::Broken;
using plc::test::Frames;
using plc::test::Log;
using test::hex;
using test::operator+;
using test::part;

namespace service_status = plc::service_status;

// The request and the response of table 5-23 (FEnet EN 5.3.5) behind a header by table 5-10.
const Bytes printed_request = hex("00 01 00 00 00 06 FF 03 00 6B 00 03");
const Bytes printed_response = hex("00 01 00 00 00 09 FF 03 06 02 2B 00 00 00 64");

TEST(Mbap, EncodesTheHeaderInFrontOfAPdu) {
  EXPECT_EQ(encode_mbap(0x0001, 0xFF, hex("03 00 6B 00 03")), printed_request);
  EXPECT_EQ(encode_mbap(0x0001, 0xFF, hex("03 06 02 2B 00 00 00 64")), printed_response);
  EXPECT_EQ(encode_mbap(0xABCD, 0x11, Bytes(253, 0x5A)).size(), 260u);
  EXPECT_EQ(part(encode_mbap(0xABCD, 0x11, Bytes(253, 0x5A)), 0, 7), hex("AB CD 00 00 00 FE 11"));
}

TEST(Mbap, ReadsTheHeader) {
  EXPECT_FALSE(read_mbap(part(printed_request, 0, 5)));
  const auto header = read_mbap(hex("12 34 56 78 01 04"));
  ASSERT_TRUE(header);
  EXPECT_EQ(header->transaction, 0x1234);
  EXPECT_EQ(header->protocol, 0x5678);
  EXPECT_EQ(header->length, 0x0104);
  EXPECT_EQ(header->frame_size(), 6u + 0x0104);
}

TEST(MbapReceiver, FindsAFrameInAnyPieces) {
  for (std::size_t cut = 1; cut < printed_request.size(); ++cut) {
    MbapReceiver receiver;
    Log log;
    receiver.receive({part(printed_request, 0, cut), 1ms}, log);
    EXPECT_TRUE(log.frames.empty()) << cut;
    receiver.receive({part(printed_request, cut, printed_request.size()), 2ms}, log);
    EXPECT_EQ(log.frames, Frames{printed_request}) << cut;
    EXPECT_EQ(log.ends, std::vector<Time>{2ms}) << cut;
    EXPECT_EQ(receiver.wake_at(), std::nullopt);
  }
}

TEST(MbapReceiver, FindsFramesThatComeTogether) {
  MbapReceiver receiver;
  Log log;
  receiver.receive({printed_request + printed_response + part(printed_request, 0, 9), 1ms}, log);
  EXPECT_EQ(log.frames, (Frames{printed_request, printed_response}));
  receiver.receive({part(printed_request, 9, 12), 2ms}, log);
  EXPECT_EQ(log.frames, (Frames{printed_request, printed_response, printed_request}));
}

TEST(MbapReceiver, AFrameOfAnotherProtocolIsFollowedToItsEnd) {
  MbapReceiver receiver;
  Log log;
  const Bytes other = hex("00 01 00 01 00 03 AA BB CC");
  receiver.receive({other + printed_request, 1ms}, log);
  EXPECT_EQ(log.frames, (Frames{other, printed_request}));
}

TEST(MbapReceiver, ALengthThatNoFrameHasEndsTheStream) {
  const auto broken_by = [](std::string_view length) {
    MbapReceiver receiver;
    Log log;
    receiver.receive({printed_request + hex("00 01 00 00" + std::string(length)), 1ms}, log);
    receiver.receive({printed_request, 2ms}, log);
    EXPECT_EQ(log.frames, Frames{printed_request}) << length;
    receiver.reset();
    receiver.receive({printed_request, 3ms}, log);
    EXPECT_EQ(log.frames, (Frames{printed_request, printed_request})) << length;
    return log.broken;
  };
  EXPECT_EQ(broken_by("00 00"), Broken{service_status::not_modbus});
  EXPECT_EQ(broken_by("00 01"), Broken{service_status::not_modbus});
  EXPECT_EQ(broken_by("01 05"), Broken{service_status::too_long});
  EXPECT_EQ(broken_by("FF FF"), Broken{service_status::too_long});
}

TEST(MbapReceiver, LengthsUpTo260AreFollowed) {
  for (const unsigned length : {2u, 254u, 255u, 260u}) {
    MbapReceiver receiver;
    Log log;
    const Bytes frame =
        hex("00 01 00 00" + hex_number(length, 4)) + Bytes(static_cast<std::size_t>(length), 0x03);
    receiver.receive({frame + printed_request, 1ms}, log);
    EXPECT_EQ(log.frames, (Frames{frame, printed_request})) << length;
  }
}

}  // namespace
}  // namespace fieldproof::modbus
