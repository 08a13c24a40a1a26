#include "src/p2p/parameters.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "src/p2p/test_driver.hpp"

namespace fieldproof::p2p {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

const plc::PlcModel& model(std::string_view name = "xbc-h") { return *plc::find_plc_model(name); }
plc::DeviceAddress address(std::string_view name) {
  return plc::parse_address(model(), name).address;
}

const json read{{"flag", "%MX00000"}, {"read", "%MW100"}, {"save", "%MW200"}, {"station", 2}};
const json send{{"function", "send"}, {"flag", "F93"}, {"frame", "TX.B"}};
const json receive{{"function", "receive"}, {"frame", "RX.B"}};

json with(json block, const json& changes) {
  block.update(changes);
  return block;
}

json without(json block, const char* key) {
  block.erase(key);
  return block;
}

P2pParameters parsed(const json& p2p, std::string_view name = "xbc-h") {
  const Result<P2pParameters> parameters = parse_p2p_parameters(p2p, model(name));
  EXPECT_TRUE(parameters) << (parameters ? "" : parameters.error().message);
  return parameters ? *parameters : P2pParameters{};
}

std::string error_of(const json& p2p, std::string_view name = "xbc-h") {
  const Result<P2pParameters> parameters = parse_p2p_parameters(p2p, model(name));
  return parameters ? "" : parameters.error().message;
}

std::string error_of_block(const json& block) {
  return error_of({{"blocks", json::array({block})}});
}

TEST(P2pParameters, Defaults) {
  const P2pParameters p2p = parsed({{"blocks", json::array({read})}});
  EXPECT_EQ(p2p.parameter, 1u);
  EXPECT_EQ(p2p.channel, 1u);
  EXPECT_TRUE(p2p.link);
  ASSERT_EQ(p2p.blocks.size(), 1u);
  const P2pBlock& block = p2p.blocks[0];
  EXPECT_EQ(block.number, 0u);
  EXPECT_EQ(block.channel, 1u);
  EXPECT_EQ(block.function, P2pBlock::Function::read);
  EXPECT_FALSE(block.continuous);
  EXPECT_EQ(block.type, 'W');
  EXPECT_EQ(block.elements(), 1u);
  EXPECT_EQ(block.station, 2u);
  EXPECT_EQ(block.condition.flag, address("%MX00000"));
  EXPECT_EQ(block.variables[0].partner, "%MW100");
  EXPECT_EQ(block.variables[0].own, address("%MW200"));
}

// Cnet EN 6.2.4, figure 6.2.7
TEST(P2pParameters, EveryKey) {
  const P2pParameters p2p =
      parsed(json::parse(R"({"parameter": 1, "channel": 2, "link": false, "blocks": [
    {"block": 7, "channel": 2, "function": "write", "flag": "%MX01020", "command": "continuous", "type": "byte", "size": 10,
     "read": "%MB250", "save": "%PB40", "station": 2},
    {"block": 3, "channel": 1, "function": "read", "flag": "F92", "type": "bit", "read": ["%MX0", "%MX1"], "save": ["%MX2", "%MX3"], "station": 255}]})"));
  EXPECT_FALSE(p2p.link);
  ASSERT_EQ(p2p.blocks.size(), 2u);
  EXPECT_EQ(p2p.blocks[0].number, 3u);  // in the order of the numbers
  EXPECT_EQ(p2p.blocks[0].variables.size(), 2u);
  EXPECT_EQ(p2p.blocks[0].type, 'X');
  const P2pBlock& block = p2p.blocks[1];
  EXPECT_EQ(block.channel, 2u);
  EXPECT_EQ(block.elements(), 10u);
  EXPECT_EQ(block.variables[0].own, address("%MB250"));
  EXPECT_EQ(block.variables[0].partner, "%PB40");
}

TEST(P2pParameters, UserFrames) {
  const P2pParameters p2p = parsed(
      {{"blocks",
        {with(send, {{"read", "%MW2"}, {"size", 2}}), with(receive, {{"save", "%MW0"}}), send}}});
  EXPECT_EQ(p2p.blocks[0].frame, "TX.B");
  EXPECT_EQ(p2p.blocks[0].size, 2u);
  EXPECT_EQ(p2p.blocks[0].variables[0].own, address("%MW2"));
  EXPECT_EQ(p2p.blocks[1].variables[0].own, address("%MW0"));
  EXPECT_TRUE(p2p.blocks[2].variables.empty());
}

TEST(P2pParameters, Clocks) {
  const auto period = [](const char* flag, std::string_view name = "xbc-h") {
    const std::string m = name == "xec-h" ? "%MW1" : "%MW200";
    return parsed({{"blocks", json::array({with(read, {{"flag", flag}, {"save", m}})})}}, name)
        .blocks.at(0)
        .condition.period;
  };
  EXPECT_EQ(period("F90"), 20ms);
  EXPECT_EQ(period("F0092"), 200ms);
  EXPECT_EQ(period("f093"), 1s);
  EXPECT_EQ(period("%FX92"), 200ms);
  EXPECT_EQ(period("_T20MS", "xec-h"), 20ms);
  EXPECT_EQ(period("_t200ms", "xec-h"), 200ms);
  EXPECT_EQ(period("_T1S", "xec-h"), 1s);
  EXPECT_EQ(period("%FX91"), 0ms);  // a bit as any other
}

TEST(P2pParameters, ErrorsOfTheWhole) {
  EXPECT_EQ(error_of(json::array()), "cannot read p2p: it is not a JSON object");
  EXPECT_THAT(error_of({{"chanel", 1}}), HasSubstr("did you mean 'channel'?"));
  EXPECT_THAT(error_of({{"parameter", 4}}),
              HasSubstr("parameter is 4, which is not a number from 0 to 3"));
  EXPECT_THAT(error_of({{"parameter", 0}}), HasSubstr("parameter is 1 to 3"));
  EXPECT_THAT(error_of({{"channel", 3}}), HasSubstr("channel is 3"));
  EXPECT_THAT(error_of(json::object()), HasSubstr("there are no blocks"));
  EXPECT_THAT(error_of({{"blocks", json::array()}}), HasSubstr("there are no blocks"));
  EXPECT_THAT(error_of({{"blocks", std::vector<json>(33, read)}}),
              HasSubstr("33 blocks; a parameter has at most 32"));
  EXPECT_EQ(error_of({{"blocks", std::vector<json>(32, read)}}), "");
  EXPECT_EQ(error_of({{"blocks", {read, with(read, {{"block", 0}})}}}),
            "cannot set up P2P block 0: it is there twice; give each block a number of its own");
  EXPECT_THAT(error_of({{"blocks", {receive, receive}}}),
              HasSubstr("P2P block 1: frame RX.B has a receive block already"));
  EXPECT_THAT(error_of({{"parameter", 2}, {"blocks", {read, with(read, {{"channel", 2}})}}}),
              HasSubstr("a module of one channel"));
  EXPECT_EQ(error_of({{"parameter", 3}, {"blocks", json::array({with(read, {{"channel", 2}})})}}),
            "");  // Cnet KO 11.2.2
  EXPECT_EQ(error_of({{"blocks", {read, with(read, {{"channel", 2}})}}}), "");
}

TEST(P2pParameters, ErrorsNameBlockAndKey) {
  EXPECT_EQ(error_of_block(1), "cannot read P2P block 0: it is not a JSON object");
  EXPECT_THAT(error_of_block(with(read, {{"colour", 1}})),
              HasSubstr("P2P block 0: there is no key 'colour'; the keys are block, channel"));
  EXPECT_THAT(error_of_block(with(read, {{"block", 32}})),
              HasSubstr("block is 32, which is not a number from 0 to 31"));
  EXPECT_THAT(error_of_block(with(read, {{"channel", 0}})), HasSubstr("channel is 0; use 1 or 2"));
  EXPECT_THAT(error_of_block(with(read, {{"station", 256}})),
              HasSubstr("P2P block 0: station is 256, which is not a number from 0 to 255"));
  EXPECT_THAT(
      error_of_block(with(read, {{"function", "raed"}})),
      HasSubstr("function is 'raed'; use one of read, write, send, receive, esend, ereceive; did "
                "you mean 'read'?"));
  EXPECT_THAT(error_of_block(with(read, {{"command", "run"}})),
              HasSubstr("use one of single, continuous"));
  EXPECT_THAT(error_of_block(with(read, {{"type", "int"}})),
              HasSubstr("use one of bit, byte, word, dword, lword"));
}

TEST(P2pParameters, ErrorsOfTheCondition) {
  EXPECT_EQ(error_of_block(with(read, {{"flag", "%MW0"}})),
            "cannot read P2P block 0: flag '%MW0' is no bit: its type is W; give a bit such as "
            "%MX00000, or a clock: "
            "F90 (20 ms), F92 (200 ms), F93 (1000 ms)");
  EXPECT_THAT(error_of_block(with(read, {{"flag", "F91"}})),
              HasSubstr("flag 'F91' is no bit of xbc-h: it does not begin with %"));
  EXPECT_THAT(error_of_block(without(read, "flag")), HasSubstr("there is no flag"));
  EXPECT_THAT(error_of_block(with(receive, {{"flag", "F92"}})),
              HasSubstr("a receive block has no flag"));
  EXPECT_THAT(error_of_block(without(send, "flag")), HasSubstr("there is no flag"));
  EXPECT_THAT(error_of({{"blocks", json::array({with(read, {{"flag", "F92"}, {"save", "%MW1"}})})}},
                       "xec-h"),
              HasSubstr("_T200MS (200 ms)"));
}

TEST(P2pParameters, ErrorsOfVariables) {
  EXPECT_THAT(error_of_block(without(read, "read")),
              HasSubstr("there is no read; a read block has read (where from) and save"));
  EXPECT_THAT(error_of_block(without(read, "save")), HasSubstr("there is no save"));
  EXPECT_THAT(error_of_block(with(read, {{"read", 1}})), HasSubstr("read is not an address"));
  EXPECT_THAT(error_of_block(with(read, {{"read", std::vector<std::string>(5, "%MW0")}})),
              HasSubstr("read has 5 addresses; a block has 1 to 4 variables"));
  EXPECT_THAT(error_of_block(with(read, {{"read", {"%MW0", "%MW1"}}})),
              HasSubstr("not the same number of addresses: 2 and 1"));
  EXPECT_THAT(error_of_block(with(read, {{"command", "continuous"},
                                         {"read", {"%MW0", "%MW1"}},
                                         {"save", {"%MW0", "%MW1"}}})),
              HasSubstr("a continuous block has one variable"));
  EXPECT_THAT(error_of_block(with(read, {{"size", 2}})), HasSubstr("size is of continuous blocks"));
  EXPECT_THAT(error_of_block(with(read, {{"command", "continuous"}, {"size", 0}})),
              HasSubstr("size is 0"));
  EXPECT_THAT(error_of_block(with(read, {{"frame", "A.B"}})),
              HasSubstr("'frame' is of send and receive blocks"));
  EXPECT_THAT(error_of_block(with(read, {{"save", "%MD0"}})),
              HasSubstr("save '%MD0' is of type dword, and the block of type word"));
  EXPECT_THAT(error_of_block(with(read, {{"save", "%ZW0"}})),
              HasSubstr("save '%ZW0' is wrong on xbc-h: the model has no such area"));
  EXPECT_THAT(error_of_block(with(read, {{"save", "%MW1024"}})),
              HasSubstr("it is beyond the area"));
  EXPECT_THAT(
      error_of_block(with(read, {{"command", "continuous"}, {"size", 2}, {"save", "%MW1023"}})),
      HasSubstr("save '%MW1023': the area ends before the last of 2 elements"));
  EXPECT_EQ(
      error_of_block(with(read, {{"command", "continuous"}, {"size", 2}, {"save", "%MW1022"}})),
      "");
  for (const char* area : {"%FW0", "%NW0"})
    EXPECT_THAT(error_of_block(with(read, {{"save", area}})), HasSubstr("is read only"));
  EXPECT_EQ(error_of_block(with(read, {{"function", "write"}, {"read", "%FW0"}, {"save", "%MW0"}})),
            "");  // F may be read
}

TEST(P2pParameters, ErrorsOfUserFrames) {
  EXPECT_THAT(error_of_block(without(send, "frame")), HasSubstr("there is no frame"));
  EXPECT_THAT(error_of_block(with(send, {{"save", "%MW0"}})),
              HasSubstr("'save' is not of a send block"));
  EXPECT_THAT(error_of_block(with(receive, {{"read", "%MW0"}})),
              HasSubstr("'read' is not of a receive block"));
  EXPECT_THAT(error_of_block(with(receive, {{"save", "%FW0"}})), HasSubstr("is read only"));
  EXPECT_THAT(error_of_block(with(send, {{"station", 1}})),
              HasSubstr("'station' is not of a send block"));
}

TEST(P2pParameters, DriversExcludeUserFrames) {
  const P2pParameters p2p = parsed({{"blocks", {read, with(send, {{"channel", 2}})}}});
  const test::TestDriver xgt("xgt-client"), frames("user-frames");
  const auto error = [&p2p](unsigned channel, const P2pDriver& driver) {
    const Status status = check_p2p_driver(p2p, channel, driver, model());
    return status ? "" : status.error().message;
  };
  EXPECT_EQ(error(1, xgt), "");
  EXPECT_EQ(error(2, frames), "");
  EXPECT_EQ(error(2, xgt),
            "cannot set up P2P block 1: a channel whose driver is xgt-client sends and receives no "
            "user frames (Cnet EN 6.2.3); set "
            "function, or another driver");
  EXPECT_THAT(error(1, frames),
              HasSubstr("P2P block 0: the driver user-frames has send and receive alone"));
}

TEST(P2pParameters, DriversHaveRulesOfTheirOwn) {
  const P2pParameters p2p = parsed({{"blocks", {read, with(read, {{"station", 99}})}}});
  const Status status = check_p2p_driver(p2p, 1, test::TestDriver(), model());
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message,
            "cannot set up P2P block 1: station is 99, which this driver has not");
}

const json mail{{"function", "esend"}, {"flag", "%MX0"}, {"message", 1}, {"to", 200}};

/// Of an Ethernet module, with e-mail settings.
Result<P2pParameters> mails(const json& block, bool settings = true) {
  json p2p{{"blocks", json::array({block})}};
  if (settings) p2p["email"] = json::object();
  return parse_p2p_parameters(p2p, model(), network_p2p_rules());
}
std::string mail_error(const json& block) {
  const Result<P2pParameters> parameters = mails(block);
  return parameters ? "" : parameters.error().message;
}

TEST(P2pMailBlocks, HaveNumbersAndBytesAndNoChannel) {
  const auto p2p = mails(with(mail, {{"data", {"%MB100", "%DB7"}}}));
  ASSERT_TRUE(p2p) << p2p.error().message;
  EXPECT_TRUE(p2p->email);
  const P2pBlock& block = p2p->blocks.at(0);
  EXPECT_TRUE(block.is_mail());
  EXPECT_EQ(block.channel, 0u);
  EXPECT_EQ(block.message, 1u);
  EXPECT_EQ(block.address, 200u);
  ASSERT_EQ(block.variables.size(), 2u);
  EXPECT_EQ(block.variables[1].own, address("%DB7"));
  EXPECT_EQ(block.condition.flag, address("%MX0"));
}

TEST(P2pMailBlocks, EreceiveNeverFires) {
  const auto p2p = mails({{"function", "ereceive"}, {"flag", "F93"}, {"info", "%MW1"}});
  ASSERT_TRUE(p2p) << p2p.error().message;
  EXPECT_FALSE(p2p->blocks.at(0).condition.flag);
  EXPECT_EQ(p2p->blocks.at(0).condition.period, 0ns);
}

TEST(P2pMailBlocks, ErrorsNameBlockAndKey) {
  EXPECT_THAT(mail_error(without(mail, "to")),
              HasSubstr("cannot read P2P block 0: there is no to; give the number of an address"));
  EXPECT_THAT(mail_error(without(mail, "message")), HasSubstr("there is no message"));
  EXPECT_THAT(mail_error(with(mail, {{"to", 256}})), HasSubstr("to is 256"));
  EXPECT_THAT(mail_error(with(mail, {{"channel", 1}})), HasSubstr("'channel' is not of an esend"));
  EXPECT_THAT(mail_error(with(mail, {{"read", "%MW1"}})), HasSubstr("'read' is not of an esend"));
  EXPECT_THAT(mail_error(with(mail, {{"data", "%MW1"}})), HasSubstr("a mail takes bytes"));
  EXPECT_THAT(mail_error(with(mail, {{"data", "%MB999999"}})), HasSubstr("data '%MB999999'"));
  EXPECT_THAT(mail_error({{"function", "ereceive"}, {"to", 1}}),
              HasSubstr("'to' is not of an ereceive block"));
  EXPECT_THAT(mail_error(with(read, {{"message", 1}})), HasSubstr("'message' is of e-mail blocks"));
  EXPECT_THAT(mails(mail, false).error().message,
              HasSubstr("cannot set up P2P block 0: there are no e-mail settings"));
  EXPECT_THAT(error_of_block(mail), HasSubstr("e-mail is sent by an Ethernet module alone"));
  EXPECT_THAT(error_of({{"email", json::object()}, {"blocks", json::array({read})}}),
              HasSubstr("there is no key 'email'"));
}

}  // namespace
}  // namespace fieldproof::p2p
