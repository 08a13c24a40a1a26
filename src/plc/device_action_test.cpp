#include "src/plc/device_action.hpp"

#include <gtest/gtest.h>

namespace fieldproof::plc {
namespace {

TEST(DeviceAction, Words) {
  EXPECT_EQ(*parse_device_action("run"), DeviceAction::run);
  EXPECT_EQ(*parse_device_action("stop"), DeviceAction::stop);
  EXPECT_EQ(*parse_device_action("power_cycle"), DeviceAction::power_cycle);
  EXPECT_EQ(parse_device_action("power-cycle").error().message,
            "cannot do 'power-cycle': there is no such action; use run, stop or power_cycle; did "
            "you mean 'power_cycle'?");
}

}  // namespace
}  // namespace fieldproof::plc
