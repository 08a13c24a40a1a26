// The LS Bus client against the inverter, in both orders of a write.
#include <gmock/gmock.h>

#include "suites/ls_bus/protocol.hpp"
#include "suites/test_p2p_pair.hpp"

namespace fieldproof::ls_bus_suite {
namespace {

using nlohmann::json;
using suites::test::get;
using suites::test::P2pPair;
using suites::test::result_of;
using suites::test::set;
using testing::Contains;
using testing::HasSubstr;

const json blocks{{{"function", "write"},
                   {"flag", "%MX00000"},
                   {"read", "%MW100"},
                   {"save", "1230"},
                   {"station", 1}},
                  {{"flag", "%MX00001"},
                   {"read", "1230"},
                   {"save", "%MW200"},
                   {"station", 1},
                   {"command", "continuous"},
                   {"size", 8}},
                  {{"flag", "%MX00002"}, {"read", "8000"}, {"save", "%MW210"}, {"station", 1}}};

json client_of(const std::string& order) {
  return {{"role", "client"}, {"write_order", order}, {"p2p", {{"blocks", blocks}}}};
}

class LsBusClient : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Orders, LsBusClient, testing::Values("address_first", "count_first"),
                         [](const auto& order) { return order.param; });

TEST_P(LsBusClient, WritesAndReadsAnInverter) {
  P2pPair pair(protocol(), {"xbc-h", client_of(GetParam())},
               {"inverter", {{"station", 1}, {"write_order", GetParam()}}});
  set(pair.client(), "%MW100", "00FF");
  set(pair.client(), "%MX00000", "01");
  EXPECT_THAT(pair.run(100ms), Contains(GetParam() == "address_first"
                                            ? "05 30 31 57 31 32 33 30 31 30 30 46 46 39 42 04"
                                            : "05 30 31 57 31 31 32 33 30 30 30 46 46 39 42 04"));
  EXPECT_EQ(get(pair.partner(), "1230"), "00FF");
  set(pair.partner(), "1231", "0001000200030004000500060007");
  set(pair.client(), "%MX00001", "01");
  set(pair.client(), "%MX00002", "01");
  pair.run(200ms);
  EXPECT_EQ(get(pair.client(), "%MW200", 32), "00FF0001000200030004000500060007");
  EXPECT_EQ(result_of(pair.client(), 0), "0001 0000 00000001 00000000");
  EXPECT_EQ(result_of(pair.client(), 1), "0001 0000 00000001 00000000");
  EXPECT_EQ(result_of(pair.client(), 2), "0002 000F 00000000 00000001") << "IA: no such parameter";
}

TEST(LsBusDevices, AreInverterAndClient) {
  const auto why = [](const char* model, const json& config) {
    const auto made = protocol().make_device(model, config);
    return made ? std::string("accepted") : made.error().message;
  };
  EXPECT_EQ(why("inverter", client_of("address_first")), "accepted")
      << "the default model, as the PLC that asks";
  EXPECT_THAT(why("xbc-h", {{"station", 1}}), HasSubstr("a PLC is its client"));
  EXPECT_THAT(why("xbc-x", {{"station", 1}}), HasSubstr("cannot make a device 'xbc-x'"));
  EXPECT_THAT(why("xbc-h", client_of("addres_first")), HasSubstr("write_order is 'addres_first'"));
}

}  // namespace
}  // namespace fieldproof::ls_bus_suite
