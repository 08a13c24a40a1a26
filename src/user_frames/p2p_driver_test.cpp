#include "src/user_frames/p2p_driver.hpp"

#include <gmock/gmock.h>

#include "src/plc/counters.hpp"
#include "src/user_frames/definition.hpp"

namespace fieldproof::user_frames {

using p2p::P2pBlock;

namespace {

using testing::HasSubstr;
using Function = P2pBlock::Function;

const plc::PlcModel& xbc = *plc::find_plc_model("xbc-h");
constexpr Duration gap = 4ms;

constexpr const char* frames = R"j({
  "title": "frames of P2P blocks",
  "groups": {
    "TX": {"type": "send", "head": [{"hex": "05"}], "tail": [{"hex": "04"}],
           "frames": {"FIXED": {"body": [{"text": "F"}, {"variable": 2, "memory": "%MW100"}]},
                      "SIZED": {"body": [{"variable": 2, "memory": true}, {"text": "-"}, {"variable": 1, "memory": true}]},
                      "OPEN": {"body": [{"text": "O"}, {"variable": true, "memory": true, "convert": "hex_to_ascii"}]},
                      "DIGITS": {"body": [{"variable": 2, "memory": "%MW100", "convert": "ascii_to_hex"}]}}},
    "RX": {"type": "receive", "head": [{"hex": "02"}], "tail": [{"hex": "03"}, {"check": "byte_sum"}],
           "frames": {"SHORT": {"body": [{"text": "S"}]},
                      "FIXED": {"body": [{"text": "F"}, {"fixed": 2, "memory": "%MW200"}]},
                      "SIZED": {"body": [{"text": "B"}, {"fixed": 2, "memory": true}, {"fixed": 1}]},
                      "REST": {"body": [{"text": "R"}, {"variable": true, "memory": true, "convert": "ascii_to_hex"}]}}},
    "LINE": {"type": "receive", "head": [{"text": ">"}],
             "frames": {"TWO": {"body": [{"fixed": 2, "memory": "%MW210"}]}, "ONE": {"body": [{"fixed": 1, "memory": "%MB440"}]}}}
  }
})j";

P2pBlock block(Function function, std::string frame, std::vector<std::string_view> own = {},
               unsigned size = 1) {
  P2pBlock made{.function = function, .size = size, .variables = {}, .frame = std::move(frame)};
  for (const std::string_view name : own)
    made.variables.push_back({"", plc::parse_address(xbc, name).address});
  return made;
}
P2pBlock send_block(std::string frame, std::vector<std::string_view> own = {}, unsigned size = 1) {
  return block(Function::send, std::move(frame), std::move(own), size);
}
P2pBlock receive_block(std::string frame, std::vector<std::string_view> own = {}) {
  return block(Function::receive, std::move(frame), std::move(own));
}

/// One channel: what is heard is offered to every block.
class UserFrameP2p : public testing::Test, private plc::FrameSink {
 protected:
  void set_up(std::vector<P2pBlock> of) {
    blocks = std::move(of);
    const auto definition = user_frames::parse_frame_definition(frames, "frames.json");
    if (!definition) throw std::runtime_error(definition.error().message);
    driver = make_user_frame_p2p_driver(*definition, blocks, gap);
    for (const P2pBlock& one : blocks) EXPECT_EQ(why(one), "accepted");
  }
  std::string why(const P2pBlock& one, const plc::PlcModel& model = xbc) {
    const Status checked = driver->check(one, model);
    return checked ? std::string("accepted") : checked.error().message;
  }
  void set(std::string_view address, std::string_view digits) {
    EXPECT_TRUE(plc::set_by_name(memory, address, digits));
  }
  std::string get(std::string_view address, std::size_t digits = 0) {
    return *plc::get_by_name(memory, address, digits);
  }
  std::string ask(const P2pBlock& of) {
    const Result<Bytes> bytes = driver->request(of, memory);
    return bytes ? to_hex(*bytes) : bytes.error().message;
  }
  /// The results since the last call, "FRAME code" each; "broken code".
  std::vector<std::string> hear(std::string_view hex, bool then_silence = false) {
    results.clear();
    now += 100ms;
    driver->receive({*from_hex(hex), now, 1ms}, *this);
    if (then_silence && driver->wake_at()) driver->advance(*driver->wake_at(), *this);
    return results;
  }

  void wait_until_just_before_the_end() {
    driver->advance(*driver->wake_at() - Duration(1), *this);
  }

  std::vector<P2pBlock> blocks;
  std::unique_ptr<p2p::P2pDriver> driver;
  plc::PlcMemory memory{xbc};

 private:
  void on_frame(ByteView frame, Time) override {
    for (const P2pBlock& one : blocks)
      if (const auto code = driver->take(one, frame, memory))
        results.push_back(one.frame + " " + hex_number(*code, 2));
  }
  void on_broken_frame(std::uint16_t why) override {
    results.push_back("broken " + hex_number(why, 2));
  }

  std::vector<std::string> results;
  Time now{};
};

using Results = std::vector<std::string>;

TEST_F(UserFrameP2p, SendsFromTheMemoryOfDefinitionOrBlock) {
  set_up({send_block("TX.FIXED"), send_block("TX.SIZED", {"%MW300", "%MB605"}),
          send_block("TX.OPEN", {"%MW002"}, 2)});
  set("%MW100", "1234");
  set("%MW300", "4142");
  set("%MB605", "43");
  set("%MW2", "00E2");
  EXPECT_EQ(ask(blocks[0]), "05 46 12 34 04");
  EXPECT_EQ(ask(blocks[1]), "05 41 42 2D 43 04");
  EXPECT_EQ(ask(blocks[2]), "05 4F 30 30 45 32 04") << "READ1: M002, SIZE1: 2 (figure 6.2.8)";
  EXPECT_FALSE(driver->awaits_reply(blocks[0]));
}

TEST_F(UserFrameP2p, CannotSendWhatIsNoHex) {
  set_up({send_block("TX.DIGITS")});
  set("%MW100", "4758");
  EXPECT_THAT(ask(blocks[0]), HasSubstr("not ASCII hex digits"));
}

TEST_F(UserFrameP2p, StoresWhatComesUnasked) {
  set_up({receive_block("RX.FIXED"), receive_block("RX.SIZED", {"%MW220"}),
          receive_block("RX.SHORT")});
  EXPECT_EQ(hear("02 46 12 34 03 91"), Results{"RX.FIXED 00"});
  EXPECT_EQ(get("%MW200"), "1234");
  EXPECT_EQ(hear("02 42 41 42 43 03 0D"), Results{"RX.SIZED 00"});
  EXPECT_EQ(get("%MW220", 8), "41420000");
  EXPECT_EQ(hear("02 53 03 58"), Results{"RX.SHORT 00"})
      << "a frame without variables is received too";
}

TEST_F(UserFrameP2p, OnlyFramesWithABlockAreArmed) {
  set_up({receive_block("LINE.ONE")});
  EXPECT_EQ(hear("3E 41"), Results{"LINE.ONE 00"})
      << "LINE.TWO, which stands first, would wait for one byte more";
  EXPECT_EQ(get("%MB440"), "41");
  EXPECT_EQ(hear("02 53 03 58"), Results{"broken 01"});
}

TEST_F(UserFrameP2p, OneFrameIsOneBlocks) {
  set_up({receive_block("LINE.ONE"), receive_block("LINE.TWO")});
  EXPECT_EQ(hear("3E 41"), Results{"LINE.ONE 00"}) << "the one that is complete first";
}

TEST_F(UserFrameP2p, DropsAFrameWhoseCheckIsWrong) {
  set_up({receive_block("RX.FIXED")});
  EXPECT_EQ(hear("02 46 12 34 03 92"), Results{"broken 03"});
  EXPECT_EQ(get("%MW200"), "0000");
  EXPECT_EQ(hear("02 46 12", true), Results{"broken 02"});
  hear("02 46 12");
  wait_until_just_before_the_end();
  EXPECT_NE(driver->wake_at(), std::nullopt) << "the rest may still come";
  driver->reset();
  EXPECT_EQ(driver->wake_at(), std::nullopt);
}

TEST_F(UserFrameP2p, SaysWhyNothingWasStored) {
  set_up({receive_block("RX.REST", {"%MW1023"})});
  EXPECT_EQ(hear("02 52 31 32 03 BA"), Results{"RX.REST 00"});
  EXPECT_EQ(get("%MW1023"), "1200");
  EXPECT_EQ(hear("02 52 31 47 03 CF"), Results{"RX.REST 0D"});
  EXPECT_EQ(hear("02 52 31 32 31 32 31 32 03 80"), Results{"RX.REST 0E"});
  EXPECT_EQ(get("%MW1023"), "1200");
}

TEST_F(UserFrameP2p, RefusesParametersThatDoNotFitTheDefinition) {
  set_up({});
  EXPECT_THAT(why(send_block("TX.FIXE")), HasSubstr("there is no frame 'TX.FIXE'"));
  EXPECT_THAT(why(send_block("TX.FIXE")), HasSubstr("did you mean 'TX.FIXED'"));
  EXPECT_THAT(why(send_block("RX.FIXED")),
              HasSubstr("frame RX.FIXED is received; name a frame of a send group"));
  EXPECT_THAT(why(receive_block("TX.FIXED")),
              HasSubstr("is sent; name a frame of a receive group"));
  EXPECT_THAT(why(send_block("TX.FIXED", {"%MW0"})),
              HasSubstr("read has 1 addresses, and frame TX.FIXED has 0 variables"));
  EXPECT_THAT(why(send_block("TX.SIZED", {"%MW0"})),
              HasSubstr("has 2 variables whose memory is the block's; give one for each"));
  EXPECT_THAT(why(receive_block("RX.SIZED", {"%MX00000"})), HasSubstr("save of body 1 is a bit"));
  EXPECT_THAT(why(send_block("TX.OPEN", {"%MW1023"}, 4)),
              HasSubstr("read of body 1: the area ends before the last of 4 bytes"));
  EXPECT_THAT(why(send_block("TX.OPEN", {"%MW0"}, 512)),
              HasSubstr("frame TX.OPEN has 1027 bytes; it may have 1024"));
  EXPECT_THAT(why(send_block("TX.FIXED"), *plc::find_plc_model("xec-h")),
              HasSubstr("the definition is for xbc-h, not for xec-h"));
}

}  // namespace
}  // namespace fieldproof::user_frames
