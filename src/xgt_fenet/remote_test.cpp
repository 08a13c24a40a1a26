#include "src/xgt_fenet/remote.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace fieldproof::xgt_fenet {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const json first{{"network", "fenet"}, {"base", 1}, {"slot", 2}, {"ip", "192.168.91.188"}};

TEST(Remote, HasOneOrTwoStages) {
  const auto one = read_remote(json::array({first}));
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->front().base, 1u);
  EXPECT_EQ(one->front().slot, 2u);
  EXPECT_EQ(one->front().ip, "192.168.91.188");
  const auto two = read_remote(json::array({first, {{"network", "cnet"}, {"slot", 3}}}));
  ASSERT_TRUE(two) << two.error().message;
  EXPECT_EQ(two->at(1).network, "cnet");
}

TEST(Remote, ErrorsNameTheStageAndTheKey) {
  const auto message = [](const json& stages) {
    const auto read = read_remote(stages);
    return read ? std::string("read") : read.error().message;
  };
  EXPECT_THAT(message({first, first, first}), HasSubstr("over remote 2 is not available"));
  EXPECT_THAT(message(json::array()), HasSubstr("give a list"));
  EXPECT_THAT(message({{{"network", "fenet"}, {"slot", 2}}}), HasSubstr("remote 1: ip is ''"));
  EXPECT_THAT(message({first, {{"network", "fnet"}}}),
              HasSubstr("remote 2: network is 'fnet'; use one of"));
  EXPECT_THAT(message({{{"network", "cnet"}, {"ip", "192.0.2.1"}}}), HasSubstr("has no ip"));
  EXPECT_THAT(message({{{"slot", 16}}}), HasSubstr("remote 1: slot is 16"));
}

}  // namespace
}  // namespace fieldproof::xgt_fenet
