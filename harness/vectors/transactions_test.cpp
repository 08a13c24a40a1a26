#include "harness/vectors/transactions.hpp"

#include <gtest/gtest.h>

namespace fieldproof::vectors::transactions_test {
namespace {

using Kind = Step::Kind;

/// One step with a frame that asks for a number.
std::string one(Transactions& transactions, Kind kind, std::string_view link = "") {
  transactions.begin(kind, link);
  const Result<std::string> number =
      kind == Kind::silence ? Result<std::string>(std::string()) : transactions.next();
  transactions.end();
  return number ? *number : number.error().message;
}

TEST(Transactions, TheNthRequestHasNAndItsReplyLikewise) {
  Transactions transactions(false);
  EXPECT_EQ(one(transactions, Kind::send), "00 01");
  EXPECT_EQ(one(transactions, Kind::expect), "00 01");
  EXPECT_EQ(one(transactions, Kind::send), "00 02");
  EXPECT_EQ(one(transactions, Kind::send), "00 03");
  EXPECT_EQ(one(transactions, Kind::expect), "00 02");
  EXPECT_EQ(one(transactions, Kind::expect), "00 03");
}

TEST(Transactions, MayStandLowByteFirst) {
  Transactions transactions(false, true);
  EXPECT_EQ(one(transactions, Kind::send), "01 00");
  EXPECT_EQ(one(transactions, Kind::expect), "01 00");
}

TEST(Transactions, ASilenceAnswersAll) {
  Transactions transactions(false);
  one(transactions, Kind::send);
  one(transactions, Kind::silence);
  EXPECT_EQ(one(transactions, Kind::send), "00 02");
  EXPECT_EQ(one(transactions, Kind::expect), "00 02");
}

TEST(Transactions, ARequestThatIsWrittenOutCounts) {
  Transactions transactions(false);
  transactions.begin(Kind::send, "");
  transactions.end();
  EXPECT_EQ(one(transactions, Kind::send), "00 02");
  EXPECT_EQ(one(transactions, Kind::expect), "00 01");
}

TEST(Transactions, TwoRequestsInOneSend) {
  Transactions transactions(false);
  transactions.begin(Kind::send, "");
  EXPECT_EQ(*transactions.next(), "00 01");
  EXPECT_EQ(*transactions.next(), "00 02");
  transactions.end();
  EXPECT_EQ(one(transactions, Kind::send), "00 03");
}

TEST(Transactions, NamedAlternativesAnswerTheSame) {
  Transactions transactions(false);
  one(transactions, Kind::send);
  one(transactions, Kind::send);
  transactions.begin(Kind::expect, "");
  EXPECT_EQ(*transactions.next(), "00 01");
  transactions.again();
  EXPECT_EQ(*transactions.next(), "00 01");
  transactions.end();
  EXPECT_EQ(one(transactions, Kind::expect), "00 02");
}

TEST(Transactions, LinksAreCountedTogetherAndAnsweredApart) {
  Transactions transactions(false);
  EXPECT_EQ(one(transactions, Kind::send, "a"), "00 01");
  EXPECT_EQ(one(transactions, Kind::send, "b"), "00 02");
  EXPECT_EQ(one(transactions, Kind::expect, "b"), "00 02");
  EXPECT_EQ(one(transactions, Kind::expect, "a"), "00 01");
}

TEST(Transactions, AReplyToNothingIsNamed) {
  Transactions transactions(false);
  EXPECT_EQ(one(transactions, Kind::expect),
            "pdu(...) answers no request that is still open; write the whole frame");
}

TEST(Transactions, ADeviceThatAsksNumbersItself) {
  Transactions transactions(true);
  EXPECT_EQ(one(transactions, Kind::expect), "{transaction:2}");
  EXPECT_EQ(one(transactions, Kind::send), "{transaction}");
  EXPECT_EQ(one(transactions, Kind::expect, "a"), "{transaction_a:2}");
  EXPECT_EQ(one(transactions, Kind::send, "a"), "{transaction_a}");
}

}  // namespace
}  // namespace fieldproof::vectors::transactions_test
