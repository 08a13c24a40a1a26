#include "suites/fuzz/mutator.hpp"

#include <gtest/gtest.h>

#include <set>

#include "suites/fuzz/targets.hpp"

namespace fieldproof::fuzz {
namespace {

TEST(Mutator, TheSameNumberIsTheSameInput) {
  const Mutator one({to_bytes("01rSS"), to_bytes("[ENQ]")}, 7),
      same({to_bytes("01rSS"), to_bytes("[ENQ]")}, 7),
      other({to_bytes("01rSS"), to_bytes("[ENQ]")}, 8);
  std::size_t different = 0;
  std::set<Bytes> inputs;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    EXPECT_EQ(one.input(i), same.input(i));
    different += one.input(i) != other.input(i);
    inputs.insert(one.input(i));
  }
  EXPECT_GT(different, 900u);
  EXPECT_GT(inputs.size(), 500u);
}

TEST(Mutator, WithoutSeedsInputsAreRandom) {
  const Mutator mutator({}, 1);
  EXPECT_NE(mutator.input(0), mutator.input(1));
}

TEST(Targets, EachHasItsNameAndGoodInputs) {
  std::set<std::string_view> names;
  for (const Target& one : targets()) {
    names.insert(one.name);
    EXPECT_FALSE(one.what.empty());
    EXPECT_EQ(find_target(one.name), &one);
  }
  EXPECT_EQ(names.size(), targets().size());
  EXPECT_EQ(find_target("nothing"), nullptr);
  EXPECT_FALSE(find_target("waivers")->seeds().empty());
}

}  // namespace
}  // namespace fieldproof::fuzz
