#include "src/udata/config.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::udata {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string refused(const json& config, std::string_view model = "xbc-h") {
  const auto parsed = parse_udata_config(model, config);
  return parsed ? "" : parsed.error().message;
}
std::string refused_instruction(const json& changes) {
  json one{{"instruction", "SNDUDATA"},
           {"request", "%MX00100"},
           {"slot", 1},
           {"channel", 2},
           {"data", "%DW100"},
           {"size", 1},
           {"info", "%DW200"}};
  one.update(changes);
  return refused({{"instructions", {one}}});
}

TEST(UdataConfig, NamesInstructionAndKey) {
  EXPECT_EQ(refused_instruction(json::object()), "");
  EXPECT_THAT(refused_instruction({{"instruction", "SNDUDATE"}}),
              HasSubstr("instruction 0: 'SNDUDATE' is no UDATA instruction of xbc-h; use one of "
                        "SNDUDATA, RCVUDATA, SENDDTR, SENDRTS; did you mean 'SNDUDATA'?"));
  EXPECT_THAT(refused_instruction({{"instruction", "SEND_UDATA"}}),
              HasSubstr("no UDATA instruction of xbc-h"));
  EXPECT_THAT(refused_instruction({{"sise", 1}}),
              HasSubstr("instruction 0 (SNDUDATA): there is no key 'sise'"));
  EXPECT_THAT(refused_instruction({{"done", "%MX0"}}), HasSubstr("there is no key 'done'"));
  EXPECT_THAT(refused_instruction({{"request", "%MW100"}}),
              HasSubstr("request is '%MW100'; give the address of a bit"));
  EXPECT_THAT(refused_instruction({{"data", "%TW100"}}),
              HasSubstr("data is '%TW100': operands lie in P M K L U D or R"));
  EXPECT_THAT(refused_instruction({{"info", "%DW10237"}}),
              HasSubstr("info is '%DW10237': 4 elements"));
  EXPECT_THAT(refused_instruction({{"size", -1}}),
              HasSubstr("size is -1; give a number from 0 to 65535 or the address of a word"));
}

TEST(UdataConfig, AReceptionNeeds1024Bytes) {
  json one{{"instruction", "RCVUDATA"}, {"request", "%MX00100"}, {"slot", 1},       {"channel", 2},
           {"data", "%DW9728"},         {"size", "%DW90"},       {"info", "%DW200"}};
  EXPECT_EQ(refused({{"instructions", {one}}}), "");
  one["data"] = "%DW9729";
  EXPECT_THAT(refused({{"instructions", {one}}}), HasSubstr("data leaves less than 1024 bytes"));
}

TEST(UdataConfig, ChecksTheModule) {
  EXPECT_THAT(refused({{"module", "xbl-c21"}}),
              HasSubstr("module is 'xbl-c21', which is none of built-in, xbl-c21a, xbl-c41a, "
                        "xbl-emta; did you mean 'xbl-c21a'?"));
  EXPECT_THAT(refused({{"module", "built-in"}, {"slot", 1}}), HasSubstr("slot is 1"));
  EXPECT_THAT(refused({{"slot", 0}}), HasSubstr("slot is 0"));
  EXPECT_THAT(refused({{"channel", 0}}), HasSubstr("channel is 0; it is 1 or 2"));
  EXPECT_THAT(refused({{"driver", "xgt"}}), HasSubstr("driver is 'xgt'"));
  EXPECT_THAT(refused({{"version", "new"}}), HasSubstr("version is 'new'"));
  EXPECT_THAT(refused({{"linkk", true}}), HasSubstr("did you mean 'link'?"));
  EXPECT_THAT(refused(json::object(), "xbm-s"), HasSubstr("Cnet KO 2.2"));
}

}  // namespace
}  // namespace fieldproof::udata
