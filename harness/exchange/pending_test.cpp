#include "harness/exchange/pending.hpp"

#include <gmock/gmock.h>

namespace fieldproof::exchange {
namespace {

using results::Event;
using testing::ElementsAre;

class PendingTest : public testing::Test {
 protected:
  void come(const std::string& text, Time start, Time end) {
    pending.add(transcript.events.insert(transcript.events.end(),
                                         {Event::Kind::received, start, end, to_bytes(text), {}}));
  }
  /// "0: abc", "left: d", each with its times in ms.
  std::vector<std::string> events() const {
    std::vector<std::string> texts;
    for (const Event& event : transcript.events)
      texts.push_back((event.surplus ? std::string("left") : std::to_string(event.step)) + ": " +
                      to_text(event.bytes) + ' ' + std::to_string(int(to_ms(event.start))) + '-' +
                      std::to_string(int(to_ms(event.end))));
    return texts;
  }

  Transcript transcript;
  Pending pending;
};

TEST_F(PendingTest, BytesOfSeveralEventsAreTakenTogether) {
  come("abc", 1ms, 2ms);
  come("def", 3ms, 4ms);
  EXPECT_EQ(pending.give(6, 0, transcript), Time(4ms));
  EXPECT_TRUE(pending.empty());
  EXPECT_THAT(events(), ElementsAre("0: abc 1-2", "0: def 3-4"));
}

TEST_F(PendingTest, AnEventOfWhichAPartIsTakenBecomesTwo) {
  come("abcdef", 1ms, 2ms);
  EXPECT_EQ(pending.give(2, 0, transcript), Time(2ms));
  EXPECT_EQ(to_text(pending.bytes()), "cdef");
  pending.leave_over(2, transcript);
  pending.give(1, 1, transcript);
  pending.drop();
  EXPECT_TRUE(pending.empty());
  EXPECT_THAT(events(), ElementsAre("0: ab 1-2", "left: cd 2-2", "1: e 2-2", "-1: f 2-2"));
}

TEST_F(PendingTest, AnEmptyDatagramIsThere) {
  come("", 1ms, 1ms);
  come("a", 2ms, 2ms);
  EXPECT_FALSE(pending.empty());
  EXPECT_TRUE(pending.front().empty());
  pending.give_front(0);
  EXPECT_EQ(to_text(pending.front()), "a");
  EXPECT_THAT(events(), ElementsAre("0:  1-1", "-1: a 2-2"));
}

}  // namespace
}  // namespace fieldproof::exchange
