#include "suites/modbus/protocol.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "suites/modbus/framing.hpp"

namespace fieldproof::modbus_suite {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Bytes hex_bytes(std::string_view hex) { return *from_hex(hex); }

TEST(Protocol, NamesItselfAndItsModels) {
  EXPECT_EQ(rtu().name(), "modbus-rtu");
  EXPECT_EQ(ascii().name(), "modbus-ascii");
  EXPECT_THAT(rtu().models(), testing::ElementsAre("xbc-h", "xbm-s", "xec-h"));
  EXPECT_EQ(rtu().station_bytes(17), Bytes{0x11});
  EXPECT_EQ(ascii().station_bytes(17), to_bytes("11"));
}

TEST(Protocol, TcpIsOfANetworkAndHasAModelMore) {
  EXPECT_EQ(tcp().name(), "modbus-tcp");
  EXPECT_EQ(tcp().default_port(), 502);
  EXPECT_EQ(rtu().default_port(), 0);
  EXPECT_THAT(tcp().models(), testing::ElementsAre("xbc-h", "xbm-s", "xec-h", "xd"));
  for (const std::string& model : tcp().models()) {
    const auto device = tcp().make_device(model, json{{"station", 1}});
    ASSERT_TRUE(device) << device.error().message;
    ASSERT_TRUE((*device)->network()) << model;
    EXPECT_TRUE((*device)->network()->listens(Transport::tcp, 502));
    EXPECT_FALSE((*device)->line());
  }
  EXPECT_FALSE(rtu().make_device("xd", json{{"station", 1}}));
}

/// What a profile declares of a XINJE PLC: its objects are where no base moves them.
TEST(Protocol, KnowsTheObjectsOfAXinjePlc) {
  for (const char* model : {"xd", "xd3", "xdc"}) {
    const auto xinje = rtu().configured(model, json{{"station", 1}});
    ASSERT_TRUE(xinje) << xinje.error().message;
    const Bytes write = (*xinje)->write_requests(1, "Y10", "01")->front();
    EXPECT_EQ(to_hex(ByteView(write).first(8)), "01 0F 60 08 00 01 01 01");
    EXPECT_EQ((*xinje)->written_by(write).front().area, "Y");
    EXPECT_THAT((*xinje)->output_areas(), testing::ElementsAre("Y", "QD"));
  }
  const auto unknown = tcp().configured("xd9", json::object());
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("xec-h, xd, xd3, xd2, xl3, xd5"));
}

/// What a frame would move is told, where an area ends, too.
TEST(Protocol, TellsWhatAFrameMovesInAXinjePlc) {
  const auto xinje = rtu().configured("xdc", json{{"station", 1}});
  ASSERT_TRUE(xinje);
  const auto moved = [&](const char* message) {
    std::string axes;
    for (const auto& one : (*xinje)->written_by(rtu_framing().wrap(hex_bytes(message))))
      for (auto word = one.first_word; !one.unknown() && word <= one.last_word; ++word)
        axes += (*xinje)->moved_by((*xinje)->spell(one.area, word));
    return axes;
  };
  EXPECT_EQ(moved("01 05 97 DA FF 00"), "1") << "SM2010";
  EXPECT_EQ(moved("01 10 78 29 00 02 04 00 00 00 00"), "22") << "SD2089, SD2090";
  EXPECT_EQ(moved("01 06 00 00 00 01"), "");
  const auto written = [&](const char* message) {
    std::string areas;
    for (const auto& one : (*xinje)->written_by(rtu_framing().wrap(hex_bytes(message))))
      areas += one.area + " ";
    return areas;
  };
  EXPECT_EQ(written("01 10 4F FF 00 02 04 00 00 00 00"), "D ? ") << "behind D20479";
  EXPECT_EQ(written("01 16 78 29 00 00 00 00"), "? ");
  EXPECT_EQ(written("01 1F 00 00 00 00 00 00"), "? ");
  EXPECT_EQ(written("01 03 00 00 00 02"), "");
}

TEST(Probe, OverTcpHasATransactionOfItsOwn) {
  const Bytes probe = tcp().probe(1, {});
  EXPECT_EQ(to_hex(ByteView(probe).subspan(2)), "00 00 00 06 01 03 00 00 00 01");
  Bytes reply = hex_bytes("00 00 00 00 00 05 01 03 02 00 00");
  std::copy_n(probe.begin(), 2, reply.begin());
  EXPECT_TRUE(tcp().is_reply_to_probe(probe, reply));
  EXPECT_EQ(tcp().probe(1, hex_bytes("00 01 00 00 00 06 01 03 00 6B 00 03"))[7], 0x01);
}

TEST(Memory, OverTcpIsThatOfRtuInAnotherFrame) {
  const auto requests = tcp().write_requests(1, "%MW100", "1234");
  ASSERT_TRUE(requests);
  EXPECT_EQ(to_hex(ByteView(requests->front()).subspan(6)), "01 10 00 64 00 01 02 12 34");
  const auto written = tcp().written_by(requests->front());
  ASSERT_EQ(written.size(), 1u);
  EXPECT_EQ(written[0].area, "M");
  EXPECT_EQ(written[0].first_word, 100u);
  const auto fields = tcp().address_fields(requests->front(), false);
  ASSERT_EQ(fields.size(), 1u);
  EXPECT_EQ(fields[0].offset, 8u);
  EXPECT_EQ(tcp().moved_field(requests->front(), fields[0], 20), hex_bytes("00 78"));
  EXPECT_EQ(*tcp().read_reply(hex_bytes("00 01 00 00 00 05 01 03 02 12 34")), "1234");
}

TEST(Protocol, OnlyRtuNeedsSilenceBetweenFrames) {
  EXPECT_GE(rtu().frame_gap(1ms), 3850us) << "3.5 characters of 11 bits, where a character has 10";
  EXPECT_EQ(ascii().frame_gap(1ms), 0ns);
}

TEST(Protocol, MakesTheDevicesOfBothModes) {
  for (const fieldproof::harness::Protocol* protocol : {&rtu(), &ascii()})
    for (const std::string& model : protocol->models()) {
      const auto device = protocol->make_device(model, json{{"station", 3}});
      ASSERT_TRUE(device) << device.error().message;
      EXPECT_EQ(*(*device)->get("%MW0", 4), "0000");
    }
  EXPECT_FALSE(rtu().make_device("xbc-h", json{{"word_read_base", "nowhere"}}));
}

TEST(Probe, ReadsOneElementByAnotherFunctionCodeThanTheTestedOne) {
  EXPECT_EQ(rtu().probe(1, {}), hex_bytes("01 03 00 00 00 01 84 0A"));
  EXPECT_EQ(ascii().probe(1, {}), to_bytes(":010300000001FB\r\n"));
  EXPECT_EQ(rtu().probe(1, hex_bytes("01 03 00 6B 00 03 74 17"))[1], 0x01);
  EXPECT_EQ(rtu().probe(1, hex_bytes("01 03 00 6B 00 03 00 00"))[1], 0x01) << "a wrong CRC";
  EXPECT_EQ(rtu().probe(1, hex_bytes("01 03 00 6B 00 03 74 17 01 01 03 12 31 05 49 D8"))[1], 0x04)
      << "two frames";
  EXPECT_EQ(to_text(ascii().probe(1, to_bytes(":0183"))).substr(3, 2), "01");
}

TEST(Probe, KnowsItsReply) {
  const Bytes probe = rtu().probe(1, {});
  EXPECT_TRUE(rtu().is_reply_to_probe(probe, hex_bytes("01 03 02 00 00 B8 44")));
  EXPECT_TRUE(rtu().is_reply_to_probe(probe, hex_bytes("01 03 02 00 00 44 B8")))
      << "its check is not judged";
  EXPECT_TRUE(rtu().is_reply_to_probe(probe, hex_bytes("01 83 02 C0 F1")));
  EXPECT_FALSE(rtu().is_reply_to_probe(probe, hex_bytes("01 01 01 00 51 88")));
  EXPECT_FALSE(rtu().is_reply_to_probe(probe, Bytes{}));
  EXPECT_TRUE(ascii().is_reply_to_probe(ascii().probe(1, {}), to_bytes(":0103020000FA\r\n")));
  EXPECT_FALSE(ascii().is_reply_to_probe(ascii().probe(1, {}), to_bytes("0103020000FA\r\n")));
}

TEST(Monitor, TellsTheSidesApart) {
  const auto seen = [](std::string_view message, bool client, bool sent) {
    return rtu().monitor_result(rtu_framing().wrap(hex_bytes(message)), client, sent);
  };
  struct Example {
    std::string_view message;
    bool request, reply;
  };
  for (const Example& one :
       {Example{"01 03 00 01 00 01", true, false}, Example{"01 03 02 12 34", false, true},
        Example{"01 83 02", false, true}, Example{"01 05 00 01 FF 00", true, true},
        Example{"01 10 00 01 00 01 02 12 34", true, false},
        Example{"01 10 00 01 00 01", false, true}, Example{"01 01 00 00 00 08", true, false}}) {
    constexpr plc::FrameResult client{4, "Modbus client"}, server{3, "Modbus server"},
        unknown = plc::unknown_frame;
    EXPECT_EQ(seen(one.message, true, true), one.request ? client : unknown) << one.message;
    EXPECT_EQ(seen(one.message, false, false), one.request ? server : unknown) << one.message;
    EXPECT_EQ(seen(one.message, true, false), one.reply ? client : unknown) << one.message;
    EXPECT_EQ(seen(one.message, false, true), one.reply ? server : unknown) << one.message;
  }
  EXPECT_EQ(rtu().monitor_result(hex_bytes("01 03 00 01 00 01 00 00"), true, true),
            plc::unknown_frame)
      << "its CRC is wrong";
  EXPECT_EQ(ascii().monitor_result(to_bytes(":010300010001FA\r\n"), true, true),
            (plc::FrameResult{4, "Modbus client"}));
}

TEST(Facts, AreComparedWithTheTables) {
  const json right{{"table", "function_code"},
                   {"code", "0F"},
                   {"name", "Force Multiple Coils"},
                   {"limit", 1968},
                   {"base", "bit_write"}};
  EXPECT_TRUE(rtu().check_fact(right)) << rtu().check_fact(right).error().message;
  json wrong = right;
  wrong["limit"] = 2000;
  EXPECT_THAT(rtu().check_fact(wrong).error().message, HasSubstr("limit = 1968, the manual 2000"));
  EXPECT_THAT(rtu().check_fact({{"table", "function_code"}, {"code", "07"}}).error().message,
              HasSubstr("no function code '07'"));
  EXPECT_TRUE(
      rtu().check_fact({{"table", "exception_code"}, {"code", "02"}, {"name", "Illegal Address"}}));
  EXPECT_FALSE(rtu().check_fact({{"table", "exception_code"}, {"code", "07"}}));
  EXPECT_TRUE(rtu().check_fact(
      {{"table", "default_bases"}, {"model", "xec-h"}, {"bit_read", "I0"}, {"word_write", "M0"}}));
  EXPECT_FALSE(
      rtu().check_fact({{"table", "default_bases"}, {"model", "xbc-h"}, {"bit_read", "I0"}}));
  EXPECT_TRUE(rtu().check_fact({{"table", "data_address"}, {"first", "0000"}, {"last", "270E"}}));
  EXPECT_FALSE(rtu().check_fact({{"table", "data_address"}, {"last", "270F"}}));
  EXPECT_FALSE(rtu().check_fact({{"table", "colour"}}));
}

}  // namespace
}  // namespace fieldproof::modbus_suite
