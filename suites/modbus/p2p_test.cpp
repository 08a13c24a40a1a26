// The Modbus client against the Modbus server: both are ours, so what is on the wire is asserted
// too.
#include <gmock/gmock.h>

#include "suites/modbus/protocol.hpp"
#include "suites/test_p2p_pair.hpp"

namespace fieldproof::modbus_suite {
namespace {

using nlohmann::json;
using suites::test::get;
using suites::test::P2pPair;
using suites::test::result_of;
using suites::test::set;
using testing::HasSubstr;

json block(const char* function, const char* type, const char* read, const char* save,
           int size = 0) {
  json made{{"function", function}, {"flag", "F92"}, {"type", type},
            {"read", read},         {"save", save},  {"station", 1}};
  if (size == 0) return made;
  made["command"] = "continuous";
  made["size"] = size;
  return made;
}

/// Cnet EN 10.3.2 with its errata: the addresses that do what the steps say (Cnet KO 11.3).
const json blocks_of_the_example{
    block("write", "word", "%MW100", "0x40001"),  block("write", "word", "%DW0", "0x40002", 4),
    block("write", "bit", "%MX0001F", "0x00142"), block("write", "bit", "%MX00020", "0x00150", 16),
    block("read", "word", "0x40002", "%MW160"),   block("read", "word", "0x30000", "%MW150", 4),
    block("read", "bit", "0x10021", "%MX01701"),  block("read", "bit", "0x000A0", "%MX01800", 16)};

json client_of(const json& blocks) { return {{"role", "client"}, {"p2p", {{"blocks", blocks}}}}; }

class ModbusClient : public testing::TestWithParam<const harness::Protocol*> {
 protected:
  P2pPair pair(const json& blocks, int station = 1) {
    return P2pPair(*GetParam(), {"xbc-h", client_of(blocks)}, {"xbc-h", {{"station", station}}});
  }
};

INSTANTIATE_TEST_SUITE_P(Modes, ModbusClient, testing::Values(&rtu(), &ascii()),
                         [](const auto& protocol) {
                           return protocol.param == &rtu() ? "rtu" : "ascii";
                         });

TEST_P(ModbusClient, DoesWhatTheExampleSays) {
  P2pPair of_example = pair(blocks_of_the_example);
  plc::EmulatedDevice &client = of_example.client(), &server = of_example.partner();
  set(client, "%MW100", "1234");
  set(client, "%DW0", "0001000200030004");
  set(client, "%MX0001F", "01");
  set(client, "%MW2", "A55A");
  set(server, "%PW0", "1111222233334444");
  set(server, "%PX00021", "01");
  set(server, "%MW10", "BEEF");
  of_example.run(2s);
  for (unsigned i = 0; i < blocks_of_the_example.size(); ++i)
    EXPECT_THAT(result_of(client, i), testing::StartsWith("0001 0000 ")) << i;
  EXPECT_EQ(get(server, "%MW1", 20), "12340001000200030004");
  EXPECT_EQ(get(server, "%MX00202"), "01");
  EXPECT_EQ(get(server, "%MW21"), "A55A");
  EXPECT_EQ(get(client, "%MW160"), "0001");
  EXPECT_EQ(get(client, "%MW150", 16), "1111222233334444");
  EXPECT_EQ(get(client, "%MX01701"), "01");
  EXPECT_EQ(get(client, "%MW180"), "BEEF");
}

TEST_P(ModbusClient, LivesOnAfterExceptionAndSilence) {
  const json blocks{block("read", "word", "0x4FFFF", "%MW150"),
                    block("read", "word", "0x40000", "%MW151")};
  P2pPair refused = pair(blocks), silent = pair(blocks, 2);
  set(refused.partner(), "%MW0", "5555");
  refused.run(350ms);
  EXPECT_EQ(result_of(refused.client(), 0), "0002 000F 00000000 00000001");
  EXPECT_EQ(result_of(refused.client(), 1), "0001 0000 00000001 00000000");
  EXPECT_EQ(get(refused.client(), "%MW150", 8), "00005555");
  silent.run(800ms);
  EXPECT_EQ(result_of(silent.client(), 0), "0002 000A 00000000 00000001");
  EXPECT_EQ(result_of(silent.client(), 1), "0002 000A 00000000 00000001");
}

/// The XEC as well; and what is said, since client and server could err together.
TEST(ModbusRtuClient, SaysItOnTheWire) {
  json of = block("read", "word", "0x3000A", "%MW150", 2);
  of["flag"] = "_T200MS";
  P2pPair pair(rtu(), {"xec-h", client_of(json{of})}, {"xec-h", {{"station", 1}}});
  set(pair.partner(), "%IW10", "12345678");
  EXPECT_THAT(pair.run(300ms),
              testing::ElementsAre("01 04 00 0A 00 02 51 C9", "01 04 04 12 34 56 78 80 B0"));
  EXPECT_EQ(get(pair.client(), "%MW150", 8), "12345678");
}

TEST(ModbusClientParameters, AreRefusedWithBlockAndKey) {
  const auto why = [](const json& blocks) {
    const auto made = rtu().make_device("xbc-h", client_of(blocks));
    return made ? std::string("accepted") : made.error().message;
  };
  EXPECT_THAT(why(json{block("write", "word", "%MW0", "0x30001")}),
              HasSubstr("cannot set up P2P block 0: save '0x30001' can only be read"));
  EXPECT_THAT(why(json{block("read", "word", "0x40001", "%MW0", 121)}),
              HasSubstr("block 0: size is 121; a modbus-rtu-client block reads 1 to 120 words"));
  EXPECT_THAT(why(json{{{"function", "send"}, {"flag", "F92"}, {"frame", "A.B"}}}),
              HasSubstr("block 0: "));
}

}  // namespace
}  // namespace fieldproof::modbus_suite
