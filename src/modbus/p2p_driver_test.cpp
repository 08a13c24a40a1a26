#include "src/modbus/p2p_driver.hpp"

#include <gmock/gmock.h>

#include "src/modbus/p2p_address.hpp"
#include "src/modbus/test_frames.hpp"
#include "src/p2p/test_blocks.hpp"
#include "src/plc/counters.hpp"

namespace fieldproof::modbus {

using p2p::P2pBlock;

namespace {

using p2p::test::p2p_read;
using p2p::test::p2p_write;
using plc::test::Broken;
using plc::test::Log;
using test::ascii;
using test::gap;
using test::hex;
using test::rtu;
using testing::HasSubstr;

const plc::PlcModel& xbc = *plc::find_plc_model("xbc-h");

class ModbusP2p : public testing::TestWithParam<ModbusMode> {
 protected:
  Bytes frame(std::string_view text) const { return test::framed(GetParam(), text); }

  void set(std::string_view address, std::string_view digits) {
    EXPECT_TRUE(plc::set_by_name(memory, address, digits));
  }
  std::string get(std::string_view address, std::size_t digits = 0) {
    return *plc::get_by_name(memory, address, digits);
  }
  Bytes ask(const P2pBlock& of) {
    const Status checked = driver->check(of, xbc);
    EXPECT_TRUE(checked) << checked.error().message;
    return *driver->request(of, memory);
  }
  std::optional<std::uint16_t> answer(const P2pBlock& of, std::string_view text) {
    return driver->take(of, frame(text), memory);
  }

  plc::PlcMemory memory{xbc};
  const std::unique_ptr<p2p::P2pDriver> driver = make_modbus_p2p_driver(GetParam(), gap);
};

INSTANTIATE_TEST_SUITE_P(Modes, ModbusP2p, testing::Values(ModbusMode::rtu, ModbusMode::ascii),
                         [](const auto& mode) {
                           return mode.param == ModbusMode::rtu ? "rtu" : "ascii";
                         });

/// The eight blocks of Cnet EN 10.3.2, with the addresses of both editions.
TEST_P(ModbusP2p, AsksAsTheExampleDoes) {
  set("%MW100", "1234");
  set("%DW0", "0001000200030004");
  set("%MX0001F", "01");
  set("%MW2", "A55A");
  EXPECT_EQ(ask(p2p_write("0x40001", "%MW100")), frame("01 06 0001 1234"));
  EXPECT_EQ(ask(p2p_write("0x40002", "%DW0", 4)), frame("01 10 0002 0004 08 0001 0002 0003 0004"));
  EXPECT_EQ(ask(p2p_write("0x00142", "%MX0001F")), frame("01 05 0142 FF00"));
  EXPECT_EQ(ask(p2p_write("0x00150", "%MX00020", 16)), frame("01 0F 0150 0010 02 5A A5"));
  EXPECT_EQ(ask(p2p_read("0x40002", "%MW160")), frame("01 03 0002 0001"));
  EXPECT_EQ(ask(p2p_read("0x30002", "%MW160")), frame("01 04 0002 0001"));
  EXPECT_EQ(ask(p2p_read("0x30000", "%MW150", 4)), frame("01 04 0000 0004"));
  EXPECT_EQ(ask(p2p_read("0x00021", "%MX01701")), frame("01 01 0021 0001"));
  EXPECT_EQ(ask(p2p_read("0x10021", "%MX01701")), frame("01 02 0021 0001"));
  EXPECT_EQ(ask(p2p_read("0x100A0", "%MX01800", 16)), frame("01 02 00A0 0010"));
}

TEST_P(ModbusP2p, WritesAZeroBitAsZero) {
  EXPECT_EQ(ask(p2p_write("0x00142", "%MX0001F")), frame("01 05 0142 0000"));
}

TEST_P(ModbusP2p, ARunOfOneIsARun) {
  set("%MW5", "BEEF");
  EXPECT_EQ(ask(p2p_write("0x40001", "%MW5", 1)), frame("01 10 0001 0001 02 BEEF"));
  EXPECT_EQ(ask(p2p_write("0x00001", "%MX00050", 1)), frame("01 0F 0001 0001 01 01"));
}

TEST_P(ModbusP2p, SavesWhatItRead) {
  const P2pBlock words = p2p_read("0x30000", "%MW150", 2),
                 bits = p2p_read("0x00010", "%MX01804", 10), bit = p2p_read("0x10021", "%MX01701");
  ask(words);
  EXPECT_EQ(answer(words, "01 04 04 1234 ABCD"), p2p::p2p_error::none);
  EXPECT_EQ(get("%MW150", 8), "1234ABCD");
  ask(bits);
  set("%MW180", "FFFF");
  EXPECT_EQ(answer(bits, "01 01 02 CD 01"), p2p::p2p_error::none);
  EXPECT_EQ(get("%MW180"), "DCDF") << "01 11001101 from bit 4 on; the bits beside stay";
  ask(bit);
  EXPECT_EQ(answer(bit, "01 02 01 01"), p2p::p2p_error::none);
  EXPECT_EQ(get("%MX01701"), "01");
}

TEST_P(ModbusP2p, TakesTheEchoOfAWrite) {
  set("%MW100", "1234");
  for (const auto& [of, reply] : {std::pair{p2p_write("0x40001", "%MW100"), "01 06 0001 1234"},
                                  {p2p_write("0x40002", "%MW100", 1), "01 10 0002 0001"},
                                  {p2p_write("0x00142", "%MX01002"), "01 05 0142 FF00"},
                                  {p2p_write("0x00150", "%MX00020", 16), "01 0F 0150 0010"}}) {
    ask(of);
    EXPECT_EQ(answer(of, reply), p2p::p2p_error::none) << reply;
  }
}

TEST_P(ModbusP2p, TheEchoIsOfWhatWasSent) {
  const P2pBlock of = p2p_write("0x40001", "%MW100");
  set("%MW100", "1234");
  ask(of);
  set("%MW100", "5678");
  EXPECT_EQ(answer(of, "01 06 0001 1234"), p2p::p2p_error::none);
  EXPECT_EQ(answer(of, "01 06 0001 5678"), p2p::p2p_error::driver);
}

/// p2p/echo: on a two-wire line it may come back. Where it has the form of a reply, it is one.
TEST_P(ModbusP2p, PassesItsOwnRequestOver) {
  const P2pBlock words = p2p_read("0x40002", "%MW160", 2), run = p2p_write("0x40002", "%MW100", 2),
                 bits = p2p_read("0x00300", "%MX01600", 20);
  ask(words);
  EXPECT_EQ(answer(words, "01 03 0002 0002"), std::nullopt);
  ask(run);
  EXPECT_EQ(answer(run, "01 10 0002 0002 04 0000 0000"), std::nullopt);
  ask(bits);
  EXPECT_EQ(answer(bits, "01 01 0300 0014"), p2p::p2p_error::none) << "3 bytes of bits: 00 00 14";
}

TEST_P(ModbusP2p, RefusesWhatIsNotTheReply) {
  const P2pBlock words = p2p_read("0x40002", "%MW160", 2), run = p2p_write("0x40002", "%MW100", 2);
  ask(words);
  for (const auto& [reply, code] : {std::pair{"02 03 04 1111 2222", p2p::p2p_error::station},
                                    {"01 04 04 1111 2222", p2p::p2p_error::driver},
                                    {"01 84 02", p2p::p2p_error::driver},
                                    {"01 83 02", p2p::p2p_error::nak},
                                    {"01 83 7F", p2p::p2p_error::nak},
                                    {"01 83", p2p::p2p_error::length},
                                    {"01 83 02 02", p2p::p2p_error::length},
                                    {"01 03", p2p::p2p_error::length},
                                    {"01 03 02 1111", p2p::p2p_error::length},
                                    {"01 03 04 1111", p2p::p2p_error::length},
                                    {"01 03 02 1111 2222", p2p::p2p_error::length},
                                    {"01 03 06 1111 2222 3333", p2p::p2p_error::length},
                                    {"01 03 0002 0003", p2p::p2p_error::length}})
    EXPECT_EQ(answer(words, reply), code) << reply;
  EXPECT_EQ(get("%MW160", 8), "00000000") << "nothing is saved of a reply that is refused";
  ask(run);
  for (const auto& [reply, code] : {std::pair{"01 10 0002 0001", p2p::p2p_error::driver},
                                    {"01 10 0003 0002", p2p::p2p_error::driver},
                                    {"01 10 0002", p2p::p2p_error::length},
                                    {"01 10 0002 0002 00", p2p::p2p_error::length},
                                    {"01 90 01", p2p::p2p_error::nak},
                                    {"01 06 0002 0002", p2p::p2p_error::driver}})
    EXPECT_EQ(answer(run, reply), code) << reply;
}

TEST_P(ModbusP2p, RefusesParametersThatHaveNoFrame) {
  const auto why = [&](const P2pBlock& of) {
    const Status checked = driver->check(of, xbc);
    return checked ? std::string("accepted") : checked.error().message;
  };
  EXPECT_THAT(why(p2p_write("0x30001", "%MW100")), HasSubstr("save '0x30001' can only be read"));
  EXPECT_THAT(why(p2p_write("0x10001", "%MX00010")), HasSubstr("can only be read"));
  EXPECT_THAT(why(p2p_read("0x10001", "%MW100")), HasSubstr("read '0x10001' holds bits"));
  EXPECT_THAT(why(p2p_read("0x40001", "%MX00010")), HasSubstr("holds words"));
  for (const char* address :
       {"", "40001", "0x2", "0x20001", "0x50001", "0x4001", "0x400001", "0x4000G", "%MW100"})
    EXPECT_THAT(why(p2p_read(address, "%MW100")), HasSubstr("no Modbus address; write 0x"))
        << address;
  EXPECT_EQ(why(p2p_read("0x4FfFf", "%MW100")), "accepted");
  EXPECT_THAT(why(p2p_read("0x4FFFF", "%MW100", 2)), HasSubstr("past data address FFFF"));
  EXPECT_THAT(why(p2p_read("0x40001", "%MB100")), HasSubstr("type is neither bit nor word"));
  P2pBlock two = p2p_read("0x40001", "%MW100");
  two.variables.push_back(two.variables.front());
  EXPECT_THAT(why(two), HasSubstr("there are 2 variables; a Modbus block has one"));
  P2pBlock send = p2p_read("0x40001", "%MW100");
  send.function = P2pBlock::Function::send;
  EXPECT_THAT(why(send), HasSubstr("neither read nor write"));
  P2pBlock mixed = p2p_read("0x40001", "%MW100");
  mixed.variables.front().own = plc::parse_address(xbc, "%MB100").address;
  EXPECT_THAT(why(mixed), HasSubstr("save is not a word"));
}

/// Cnet KO 6.4.2, and that the longest frames are as long as a frame may be.
TEST_P(ModbusP2p, KeepsTheSizesOfTheManual) {
  const bool in_rtu = GetParam() == ModbusMode::rtu;
  const auto limit = [&](const P2pBlock& at_limit) {
    P2pBlock past = at_limit;
    ++past.size;
    EXPECT_TRUE(driver->check(at_limit, xbc)) << driver->check(at_limit, xbc).error().message;
    EXPECT_FALSE(driver->check(past, xbc)) << past.size;
    past.size = 0;
    EXPECT_FALSE(driver->check(past, xbc)) << "none";
  };
  limit(p2p_read("0x00000", "%MX00000", in_rtu ? 2000 : 976));
  limit(p2p_read("0x30000", "%MW0", in_rtu ? 120 : 61));
  limit(p2p_write("0x00000", "%MX00000", in_rtu ? 1968 : 944));
  limit(p2p_write("0x40000", "%MW0", in_rtu ? 120 : 59));
  if (in_rtu) return;
  EXPECT_EQ(ask(p2p_write("0x00000", "%MX00000", 944)).size(), 255u);
  EXPECT_EQ(ask(p2p_write("0x40000", "%MW0", 59)).size(), 255u);
}

TEST(ModbusP2pRtu, AWrongCrcIsABccError) {
  const auto driver = make_modbus_p2p_driver(ModbusMode::rtu, gap);
  plc::PlcMemory memory(xbc);
  const P2pBlock of = p2p_read("0x40002", "%MW160");
  EXPECT_TRUE(driver->request(of, memory));
  Bytes reply = rtu("01 03 02 1234");
  reply.back() ^= 1;
  EXPECT_EQ(driver->take(of, reply, memory), p2p::p2p_error::bcc);
  EXPECT_EQ(driver->take(of, hex("01"), memory), p2p::p2p_error::length);
  EXPECT_EQ(driver->take(of, hex("01 03 02"), memory), p2p::p2p_error::length);
}

TEST(ModbusP2pAscii, TellsCheckDigitsAndLengthApart) {
  const auto driver = make_modbus_p2p_driver(ModbusMode::ascii, gap);
  plc::PlcMemory memory(xbc);
  const P2pBlock of = p2p_read("0x40002", "%MW160");
  EXPECT_TRUE(driver->request(of, memory));
  EXPECT_EQ(driver->take(of, to_bytes(":0103021234B5\r\n"), memory), p2p::p2p_error::bcc);
  EXPECT_EQ(driver->take(of, to_bytes(":01030212G4B4\r\n"), memory), p2p::p2p_error::not_hex);
  EXPECT_EQ(driver->take(of, to_bytes(":0103021234B\r\n"), memory), p2p::p2p_error::not_hex);
  EXPECT_EQ(driver->take(of, to_bytes(":01\r\n"), memory), p2p::p2p_error::length);
  EXPECT_EQ(driver->take(of, to_bytes(":0103021234b4\r\n"), memory), p2p::p2p_error::none);
}

TEST(ModbusP2pRtu, SilenceEndsAFrame) {
  const auto driver = make_modbus_p2p_driver(ModbusMode::rtu, gap);
  Log log;
  const Bytes reply = rtu("01 03 02 1234");
  driver->receive({reply, 10ms, 1ms}, log);
  EXPECT_TRUE(log.frames.empty());
  ASSERT_EQ(driver->wake_at(), 10ms + 7ms + gap + 1ms);
  driver->advance(*driver->wake_at(), log);
  EXPECT_EQ(log.frames, plc::test::Frames{reply});
  driver->receive({reply, 100ms, 1ms}, log);
  driver->reset();
  EXPECT_EQ(driver->wake_at(), std::nullopt);
}

TEST(ModbusP2pAscii, SaysWhetherHeadOrTailIsMissing) {
  const auto driver = make_modbus_p2p_driver(ModbusMode::ascii, gap);
  Log log;
  driver->receive({to_bytes("0103021234B4\r\n"), 10ms, 1ms}, log);
  EXPECT_EQ(log.broken, Broken{p2p::p2p_error::head});
  driver->reset();
  driver->receive({to_bytes(":0103021234B4"), 100ms, 1ms}, log);
  driver->advance(*driver->wake_at(), log);
  EXPECT_EQ(log.broken, (Broken{p2p::p2p_error::head, p2p::p2p_error::tail}));
  driver->receive({Bytes(600, '0'), 5s, 1ms}, log);
  Bytes endless(600, '0');
  endless.front() = ':';
  log.broken.clear();
  driver->receive({endless, 9s, 1ms}, log);
  EXPECT_EQ(log.broken, Broken{p2p::p2p_error::length});
}

}  // namespace
}  // namespace fieldproof::modbus
