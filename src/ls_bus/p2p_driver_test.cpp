#include "src/ls_bus/p2p_driver.hpp"

#include <gmock/gmock.h>

#include "src/p2p/test_blocks.hpp"
#include "src/plc/test_frame_log.hpp"

namespace fieldproof::ls_bus {

using p2p::P2pBlock;

namespace {

using p2p::test::p2p_read;
using p2p::test::p2p_write;
using plc::test::Broken;
using plc::test::Log;
using testing::HasSubstr;

const plc::PlcModel& xbc = *plc::find_plc_model("xbc-h");
constexpr Duration gap = 4ms;

/// Header, body with its sum, EOT.
Bytes frame(Byte header, std::string_view body) {
  const Bytes summed = to_bytes(body);
  return to_bytes(static_cast<char>(header) + std::string(body) + hex_number(ls_sum(summed), 2) +
                  '\x04');
}
Bytes ack(std::string_view body) { return frame(ls_ack, body); }
Bytes nak(std::string_view body) { return frame(ls_nak, body); }

class LsBusP2p : public testing::Test {
 protected:
  void set(std::string_view address, std::string_view digits) {
    EXPECT_TRUE(plc::set_by_name(memory, address, digits));
  }
  std::string get(std::string_view address, std::size_t digits = 0) {
    return *plc::get_by_name(memory, address, digits);
  }
  std::string ask(const P2pBlock& of) {
    const Status checked = driver->check(of, xbc);
    EXPECT_TRUE(checked) << checked.error().message;
    return to_text(*driver->request(of, memory));
  }
  std::optional<std::uint16_t> answer(const P2pBlock& of, const Bytes& reply) {
    return driver->take(of, reply, memory);
  }

  plc::PlcMemory memory{xbc};
  std::unique_ptr<p2p::P2pDriver> driver = make_ls_bus_p2p_driver(LsWriteOrder::address_first, gap);
};

/// The examples of 8.2, sums added up by hand.
TEST_F(LsBusP2p, AsksAsTheExamplesDo) {
  set("%MW100", "00FF");
  EXPECT_EQ(ask(p2p_write("1230", "%MW100")),
            "\x05"
            "01W1230100FF9B\x04");
  EXPECT_EQ(ask(p2p_read("1230", "%MW100")),
            "\x05"
            "01R12301AA\x04");
  EXPECT_EQ(ask(p2p_read("h1230", "%MW100", 1)),
            "\x05"
            "01R12301AA\x04");
  driver = make_ls_bus_p2p_driver(LsWriteOrder::count_first, gap);
  EXPECT_EQ(ask(p2p_write("1230", "%MW100")),
            "\x05"
            "01W1123000FF9B\x04");
  EXPECT_EQ(ask(p2p_read("1230", "%MW100")),
            "\x05"
            "01R12301AA\x04")
      << "only a write has two orders";
}

TEST_F(LsBusP2p, EightWordsFillAFrame) {
  set("%MW100", "11112222333344445555666677778888");
  const std::string longest = ask(p2p_write("0100", "%MW100", 8));
  EXPECT_EQ(longest.size(), ls_max_frame);
  EXPECT_EQ(longest.substr(1, 8), "01W01008");
  EXPECT_EQ(longest.substr(9, 32), "11112222333344445555666677778888");
}

TEST_F(LsBusP2p, SavesWhatItRead) {
  const P2pBlock of = p2p_read("1230", "%MW200", 2);
  ask(of);
  EXPECT_EQ(answer(of, ack("01R1234abCD")), p2p::p2p_error::none);
  EXPECT_EQ(get("%MW200", 8), "1234ABCD");
}

TEST_F(LsBusP2p, TakesTheEchoOfWhatWasSent) {
  const P2pBlock of = p2p_write("1230", "%MW100");
  set("%MW100", "00FF");
  ask(of);
  set("%MW100", "0100");
  EXPECT_EQ(answer(of, ack("01W00FF")), p2p::p2p_error::none);
  EXPECT_EQ(answer(of, ack("01W0100")), p2p::p2p_error::driver);
  EXPECT_EQ(answer(of, ack("01W")), p2p::p2p_error::length);
}

TEST_F(LsBusP2p, RefusesWhatIsNotTheReply) {
  const P2pBlock of = p2p_read("1230", "%MW200", 2);
  ask(of);
  Bytes wrong_sum = ack("01R11112222");
  wrong_sum[wrong_sum.size() - 2] ^= 1;
  EXPECT_EQ(answer(of, wrong_sum), p2p::p2p_error::bcc);
  EXPECT_EQ(answer(of, ack("02R11112222")), p2p::p2p_error::station);
  EXPECT_EQ(answer(of, ack("0GR11112222")), p2p::p2p_error::not_hex);
  EXPECT_EQ(answer(of, ack("01W11112222")), p2p::p2p_error::driver);
  EXPECT_EQ(answer(of, ack("01R1111")), p2p::p2p_error::length);
  EXPECT_EQ(answer(of, ack("01R111122223333")), p2p::p2p_error::length);
  EXPECT_EQ(answer(of, ack("01R1111222G")), p2p::p2p_error::not_hex);
  EXPECT_EQ(answer(of, to_bytes("\x06\x04")), p2p::p2p_error::length);
  EXPECT_EQ(answer(of, nak("01R12")), p2p::p2p_error::nak);
  EXPECT_EQ(answer(of, nak("01RIA")), p2p::p2p_error::nak);
  EXPECT_EQ(answer(of, nak("01R0012")), p2p::p2p_error::length);
  EXPECT_EQ(get("%MW200", 8), "00000000") << "nothing is saved of a reply that is refused";
}

TEST_F(LsBusP2p, RefusesParametersThatHaveNoFrame) {
  const auto why = [&](const P2pBlock& of) {
    const Status checked = driver->check(of, xbc);
    return checked ? std::string("accepted") : checked.error().message;
  };
  EXPECT_EQ(why(p2p_read("1230", "%MW100", 8)), "accepted");
  EXPECT_THAT(why(p2p_read("1230", "%MW100", 9)),
              HasSubstr("size is 9; an LS Bus block has 1 to 8 words"));
  EXPECT_THAT(why(p2p_read("1230", "%MX00100")), HasSubstr("type is not word"));
  for (const char* address : {"", "123", "12300", "123G", "%MW100", "h123"})
    EXPECT_THAT(why(p2p_write(address, "%MW100")), HasSubstr("no address of an inverter"))
        << address;
  EXPECT_THAT(why(p2p_write("FFFF", "%MW100", 2)), HasSubstr("past FFFF"));
  EXPECT_EQ(why(p2p_write("FFFE", "%MW100", 2)), "accepted");
  P2pBlock odd = p2p_read("1230", "%MW100");
  odd.variables.push_back(odd.variables.front());
  EXPECT_THAT(why(odd), HasSubstr("there are 2 variables"));
  odd = p2p_read("1230", "%MW100");
  odd.function = P2pBlock::Function::receive;
  EXPECT_THAT(why(odd), HasSubstr("neither read nor write"));
  odd = p2p_read("1230", "%MW100");
  odd.variables.front().own = plc::parse_address(xbc, "%MB100").address;
  EXPECT_THAT(why(odd), HasSubstr("save is not a word"));
}

TEST_F(LsBusP2p, FindsRepliesAndTellsWhatIsNone) {
  Log log;
  const Bytes reply = ack("01R1234");
  driver->receive({to_bytes("\x05??"), 1ms, 1ms}, log);
  EXPECT_EQ(log.broken, Broken{p2p::p2p_error::head})
      << "the echo of a request, once for a run of bytes";
  driver->receive({reply, 10ms, 1ms}, log);
  EXPECT_EQ(log.frames, std::vector<Bytes>{reply});
  EXPECT_EQ(driver->wake_at(), std::nullopt);
  driver->receive({nak("01R12"), 50ms, 1ms}, log);
  EXPECT_EQ(log.frames.size(), 2u);
  driver->receive({Bytes(1, ls_ack), 100ms, 1ms}, log);
  driver->receive({Bytes(300, '0'), 101ms, 1ms}, log);
  EXPECT_EQ(log.broken,
            (Broken{p2p::p2p_error::head, p2p::p2p_error::length, p2p::p2p_error::head}));
}

TEST_F(LsBusP2p, SilenceWithoutTailEndsAFrame) {
  Log log;
  driver->receive({to_bytes("\x06"
                            "01R"),
                   10ms, 1ms},
                  log);
  ASSERT_EQ(driver->wake_at(), 14ms + gap + 1ms + Duration(1));
  driver->advance(*driver->wake_at() - Duration(1), log);
  EXPECT_EQ(log.broken, Broken{});
  driver->advance(*driver->wake_at(), log);
  EXPECT_EQ(log.broken, Broken{p2p::p2p_error::tail});
  EXPECT_EQ(driver->wake_at(), std::nullopt);
  driver->receive({to_bytes("\x06"
                            "01R"),
                   50ms, 1ms},
                  log);
  driver->reset();
  EXPECT_EQ(driver->wake_at(), std::nullopt);
}

}  // namespace
}  // namespace fieldproof::ls_bus
