#include "reports/text/failures.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/samples.hpp"

namespace fieldproof::text {
namespace {

using results::Verdict;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::SizeIs;

results::CaseResult failed(int number, const std::string& message) {
  return samples::with(Verdict::fail, "a/b/" + std::to_string(number), message);
}

TEST(KindOf, LeavesOutTheValuesOfACase) {
  EXPECT_EQ(kind_of("no answer within 500 ms"), "no answer within # ms");
  EXPECT_EQ(kind_of("BCC: expected 0F, got AB"), "BCC: expected #, got #");
  EXPECT_EQ(kind_of("12 bytes came where silence is due: ACK '01rSS' <15><16> ETX"),
            "# bytes came where silence is due: ACK # ETX");
  EXPECT_EQ(kind_of("%MW100 holds 1234, ABCD is due"), kind_of("%MX7 holds 00, 01 is due"));
  EXPECT_EQ(kind_of("'never closed"), "#");
  EXPECT_EQ(kind_of(""), "");
}

TEST(KindOf, KeepsWhatIsWrong) {
  EXPECT_NE(kind_of("BCC: expected 0F, got 09"), kind_of("station: expected 0F, got 09"));
  EXPECT_NE(kind_of("no answer within 500 ms"), kind_of("the device floods the line"));
  EXPECT_EQ(kind_of("no ACK"), "no ACK");
}

TEST(Failures, OfOneKindAreOneFinding) {
  Failures failures;
  for (int i = 1; i <= 1200; ++i) failures.add(failed(i, "no answer within 500 ms"));
  const Finding& last = failures.add(failed(1201, "no answer within 500 ms"));
  EXPECT_TRUE(last.is_again());
  EXPECT_EQ(to_string(last), "1,201 cases: no answer within 500 ms (first: a/b/1, a/b/2, a/b/3)");
  EXPECT_THAT(failures.repeated(), ElementsAre(&last));
  EXPECT_THAT(failures.single(), IsEmpty());
}

TEST(Failures, SayWhereTheirMessagesDiffer) {
  Failures failures;
  for (int i = 1; i <= 4; ++i) failures.add(failed(i, "BCC: expected 0" + std::to_string(i)));
  ASSERT_THAT(failures.repeated(), SizeIs(1));
  EXPECT_EQ(to_string(*failures.repeated()[0]),
            "4 cases: alike, as BCC: expected 01 (first: a/b/1, a/b/2, a/b/3)");
}

TEST(Failures, FewOfAKindStayAloneInTheirOrder) {
  Failures failures;
  failures.add(failed(1, "late"));
  for (int i = 2; i <= 6; ++i) failures.add(failed(i, "no answer within 500 ms"));
  failures.add(failed(7, "wrong"));
  EXPECT_FALSE(failures.add(failed(8, "late")).is_again());
  EXPECT_THAT(failures.single(), ElementsAre("a/b/1", "a/b/7", "a/b/8"));
  EXPECT_THAT(failures.repeated(), SizeIs(1));
}

TEST(Failures, AnErrorIsAnother) {
  Failures failures;
  const auto of = [&](Verdict verdict) {
    return failures.add(samples::with(verdict, "a/b", "no answer")).number;
  };
  EXPECT_EQ(of(Verdict::fail), 1u);
  EXPECT_EQ(of(Verdict::error), 2u);
  EXPECT_EQ(of(Verdict::fail), 1u);
}

/// A device that fails each case in another way: memory is bounded all the same.
TEST(Failures, KindsAreBounded) {
  Failures failures;
  for (int i = 0; i < 3000; ++i) {
    std::string name;
    for (int rest = i + 1; rest > 0; rest /= 10) name += static_cast<char>('k' + rest % 10);
    failures.add(failed(i, name + " is wrong"));
  }
  EXPECT_LE(failures.single().size(), 1000u);
  ASSERT_THAT(failures.repeated(), SizeIs(1));
  EXPECT_EQ(failures.repeated()[0]->cases, 2000u);
}

}  // namespace
}  // namespace fieldproof::text
