#include "harness/vectors/fault_matrix.hpp"

#include <gmock/gmock.h>

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const FaultMatrix matrix{{"plc",
                          {"deaf", "mute", "late", "early"},
                          {{"a/1", {0, 1, 2}}, {"a/2", {0, 1, 2}}, {"a/3", {3}}, {"a/4", {}}}},
                         {"inverter", {"deaf"}, {{"b/1", {0}}}}};

TEST(FaultMatrix, ReadsWhatItWrites) {
  const std::string text = to_text(matrix);
  EXPECT_THAT(text, HasSubstr("\"a/1\": \"0-2\""));
  const Result<FaultMatrix> read = parse_fault_matrix(text);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(to_text(*read), text);
  EXPECT_EQ((*read)[0].killed.at("a/3"), std::set<std::size_t>{3});
}

TEST(FaultMatrix, AFaultThatIsNotListedIsAnError) {
  const auto read =
      parse_fault_matrix(R"([{"device": "d", "faults": ["x"], "cases": {"a": "0-1"}}])");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("there is no fault 1"));
}

TEST(FaultMatrix, CasesThatNoFaultTellsApartAreAGroup) {
  const std::vector<Alike> alike = not_told_apart(matrix, {"a/1", "a/2", "a/3", "a/4", "b/1"});
  ASSERT_EQ(alike.size(), 2u);
  EXPECT_EQ(alike[0].by, "");
  EXPECT_THAT(alike[0].cases, ElementsAre("a/4"));
  EXPECT_EQ(alike[1].by, "0-2");
  EXPECT_THAT(alike[1].cases, ElementsAre("a/1", "a/2"));
  EXPECT_THAT(not_told_apart(matrix, {"a/1", "a/3"}), IsEmpty());
}

TEST(FaultMatrix, KilledByAnyLeavesOutWhatNoFaultTurnsRed) {
  EXPECT_THAT(killed_by_any(matrix), ElementsAre("a/1", "a/2", "a/3", "b/1"));
}

}  // namespace
}  // namespace fieldproof::vectors
