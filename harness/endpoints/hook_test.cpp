#include "harness/endpoints/hook.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <thread>

#include "harness/endpoints/interrupt.hpp"

namespace fieldproof {
namespace {

using testing::HasSubstr;

TEST(Hook, GetsArgumentsAndEnvironment) {
  EXPECT_TRUE(run_hook("test \"$SPEED\" = 38400 && test 8N1 =", {"8N1"}, {{"SPEED", "38400"}}));
  const Status failed = run_hook("test \"$SPEED\" = 9600 && test 8N1 =", {"8N1"}, {{"SPEED", "38400"}});
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message, HasSubstr("failed: exit status 1"));
}

TEST(Hook, SaysHowItEnded) {
  EXPECT_THAT(run_hook("exit 7;", {}, {}).error().message, HasSubstr("exit status 7"));
  EXPECT_THAT(run_hook("kill -9 $$;", {}, {}).error().message, HasSubstr("signal 9"));
}

TEST(Hook, IsEndedByAnInterrupt) {
  std::thread later([] { interrupt(); });
  const Status ended = run_hook("exec sleep 3600; :", {}, {});
  later.join();
  clear_interrupt();
  ASSERT_FALSE(ended);
  EXPECT_TRUE(ended.error().interrupted);
}

}  // namespace
}  // namespace fieldproof
