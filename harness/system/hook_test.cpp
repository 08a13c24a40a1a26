#include "harness/system/hook.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <thread>

#include "harness/system/interrupt.hpp"

namespace fieldproof::os {
namespace {

using testing::HasSubstr;

TEST(Hook, GetsArgumentsAndEnvironment) {
  EXPECT_TRUE(run_hook("test \"$SPEED\" = 38400 && test 8N1 =", {"8N1"}, {{"SPEED", "38400"}}));
  const Status failed =
      run_hook("test \"$SPEED\" = 9600 && test 8N1 =", {"8N1"}, {{"SPEED", "38400"}});
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message, HasSubstr("failed: exit status 1"));
}

TEST(Hook, SaysHowItEnded) {
  EXPECT_THAT(run_hook("exit 7;", {}, {}).error().message, HasSubstr("exit status 7"));
  EXPECT_THAT(run_hook("kill -9 $$;", {}, {}).error().message, HasSubstr("signal 9"));
}

/// Standard input from a pipe, for as long as it lives.
class Input {
 public:
  Input() : kept_(::dup(STDIN_FILENO)) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(::pipe(ends), 0);
    ::dup2(ends[0], STDIN_FILENO);
    ::close(ends[0]);
    write_ = ends[1];
  }
  ~Input() {
    end();
    ::dup2(kept_, STDIN_FILENO);
    ::close(kept_);
  }
  void type(const std::string& text) {
    EXPECT_EQ(::write(write_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void end() {
    if (write_ >= 0) ::close(write_);
    write_ = -1;
  }

 private:
  int kept_ = -1, write_ = -1;
};

TEST(Hook, AsksLineByLine) {
  Input input;
  input.type("\nskip\n");
  EXPECT_EQ("", *ask("one? "));
  EXPECT_EQ("skip", *ask("two? "));
  input.end();
  EXPECT_THAT(ask("three? ").error().message, HasSubstr("there is no input"));
}

TEST(Hook, AQuestionCanBeInterrupted) {
  Input input;
  std::thread later([] { interrupt(); });
  const Result<std::string> answer = ask("? ");
  later.join();
  clear_interrupt();
  ASSERT_FALSE(answer);
  EXPECT_TRUE(answer.error().interrupted);
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
}  // namespace fieldproof::os
