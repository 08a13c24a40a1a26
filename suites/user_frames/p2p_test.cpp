// SEND and RECEIVE blocks against the stand-in controller of Cnet EN 10.4.
#include <gmock/gmock.h>

#include "suites/test_p2p_pair.hpp"
#include "suites/user_frames/protocol.hpp"

namespace fieldproof::user_frames_suite {
namespace {

using nlohmann::json;
using suites::test::get;
using suites::test::P2pPair;
using suites::test::result_of;
using suites::test::set;
using testing::HasSubstr;
using testing::IsEmpty;

const json blocks{{{"function", "send"}, {"flag", "F93"}, {"frame", "DRS.test"}},
                  {{"function", "receive"}, {"frame", "DRS_RECE.RECE_DRS"}}};
const json asks{{"role", "client"}, {"p2p", {{"blocks", blocks}}}};

TEST(UserFrameClient, ReadsTheTemperatureEverySecond) {
  for (const auto& [model, more] :
       {std::pair{"px7", json::object()}, {"xbc-h", json{{"definition", "px7"}}}}) {
    json config = asks;
    config.update(more);
    P2pPair pair(protocol(), {model, config}, {"px7_controller", {{"station", 1}}});
    set(pair.partner(), "%DW1", "0019001E");
    EXPECT_THAT(pair.run(999ms), IsEmpty());
    EXPECT_THAT(pair.run(500ms), testing::ElementsAre(to_hex(to_bytes("\x02"
                                                                      "01DRS,02,0001\r\n")),
                                                      to_hex(to_bytes("\x02"
                                                                      "01DRS,OK,0019,001E\r\n"))));
    EXPECT_EQ(get(pair.client(), "%MW200", 8), "30303139");
    EXPECT_EQ(get(pair.client(), "%MW210", 8), "30303145");
    pair.run(1s);
    EXPECT_EQ(result_of(pair.client(), 0), "0001 0000 00000002 00000000");
    EXPECT_EQ(result_of(pair.client(), 1), "0001 0000 00000002 00000000");
  }
}

TEST(UserFrameClient, ParametersAreRefusedWithBlockAndKey) {
  const auto why = [](const char* model, const json& config) {
    const auto made = protocol().make_device(model, config);
    return made ? std::string("accepted") : made.error().message;
  };
  json unknown = asks;
  unknown["p2p"]["blocks"][0]["frame"] = "DRS.tset";
  EXPECT_THAT(why("px7", unknown),
              HasSubstr("cannot set up P2P block 0: there is no frame 'DRS.tset'"));
  EXPECT_THAT(why("px7", unknown), HasSubstr("did you mean 'DRS.test'"));
  EXPECT_THAT(why("xbc-h", asks), HasSubstr("definition"));
  json foreign = asks;
  foreign["definition"] = "px7";
  foreign["p2p"]["blocks"][0]["flag"] = "_T1S";
  EXPECT_THAT(why("xec-h", foreign),
              HasSubstr("block 0: the definition is for xbc-h, not for xec-h"));
}

/// "definition" names the frames of a port without P2P too.
TEST(UserFramePort, TakesItsDefinitionFromTheConfiguration) {
  const auto port = protocol().make_device("xbc-h", {{"definition", "px7"}});
  ASSERT_TRUE(port) << port.error().message;
  EXPECT_TRUE((*port)->act("send DRS.test"));
}

}  // namespace
}  // namespace fieldproof::user_frames_suite
