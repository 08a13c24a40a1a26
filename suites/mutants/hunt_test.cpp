#include "suites/mutants/hunt.hpp"

#include <gmock/gmock.h>

#include <csignal>

#include "suites/mutants/mutant.hpp"
#include "suites/mutants/report.hpp"

namespace fieldproof::mutants {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A table that devices set up when they are loaded.
int first_row = 0;
void set_up() { first_row = is_mutant(6) ? 11 : 10; }

/// A source with six mutants, as generate.py writes them.
int least(int a, int b) {
  if (is_mutant(5) ? (a > 1000) : (a > 100)) return 0;
  {
    if (!is_mutant(3)) {
      a += 0;
    }
  }  // nothing shows it
  if (is_mutant(4)) std::raise(SIGSEGV);
  return (is_mutant(1) ? (a > b) : is_mutant(2) ? (a <= b) : (a < b)) ? a : b;
}

Trial trial(const std::string& name, std::function<bool()> red) {
  return {name, "protocol", "manual, 1", [red](const MutatedDevices&) { return red(); }};
}

std::vector<Mutant> mutants(int count) {
  std::vector<Mutant> all;
  for (int id = 1; id <= count; ++id) {
    all.emplace_back();
    all.back().id = id;
    all.back().protocol = "protocol";
    all.back().file = "src/a/b.cpp";
    all.back().once = id == 6;
  }
  return all;
}

/// `seconds` of processor time a step: a crash under sanitizers takes half of one.
HuntOptions options(double seconds = 10) {
  static const MutatedDevices devices(nullptr);
  static std::vector<unsigned char> reached(8);
  become(0, reached.data());
  set_up();
  return {
      &devices, [] { return set_up(), Result<MutatedDevices>(devices); }, 7, {2, seconds, 0}, {}};
}

struct Hunt : testing::Test {
  std::vector<Mutant> all = mutants(7);
  std::vector<Outcome> outcomes = std::vector<Outcome>(7);
  std::vector<Fate> fates() const {
    std::vector<Fate> list;
    for (const Outcome& one : outcomes) list.push_back(one.fate);
    return list;
  }
};

TEST_F(Hunt, KillsWhatACaseSeesAndKeepsWhatNoneSees) {
  const Stage stage{"vectors",
                    {trial("two numbers", [] { return least(1, 2) != 1; }),
                     trial("the other way round", [] { return least(2, 1) != 1; }),
                     trial("a table", [] { return first_row != 10 || least(3, 4) != 3; })}};
  ASSERT_TRUE(hunt(stage, all, options(), outcomes));
  EXPECT_THAT(fates(), ElementsAre(Fate::red, Fate::survived, Fate::survived, Fate::crashed,
                                   Fate::survived, Fate::red, Fate::unreached));
  EXPECT_EQ(outcomes[5].by, "a table");
  EXPECT_EQ(outcomes[0].stage, "vectors");
}

TEST_F(Hunt, ALaterStageSeesWhatLives) {
  const Stage first{"vectors", {trial("two numbers", [] { return least(1, 2) != 1; })}};
  const Stage second{"derived", {trial("endless", [] {
                       while (is_mutant(2)) fieldproof_reached[0] = 1;
                       return false;
                     })}};
  ASSERT_TRUE(hunt(first, all, options(), outcomes));
  EXPECT_EQ(outcomes[1].fate, Fate::survived);
  ASSERT_TRUE(hunt(second, all, options(0.2), outcomes));
  EXPECT_EQ(outcomes[0].stage, "vectors");
  EXPECT_EQ(outcomes[1].fate, Fate::hung);
  EXPECT_EQ(outcomes[1].stage, "derived");
}

TEST_F(Hunt, ATrialThatIsRedOnTheHealthyDeviceShowsNothing) {
  const Stage stage{"vectors",
                    {trial("always red", [] { return least(1, 2) == 1; }),
                     trial("good", [] { return least(2, 1) != 1; })}};
  ASSERT_TRUE(hunt(stage, all, options(), outcomes));
  EXPECT_EQ(outcomes[0].by, "good");
  outcomes.assign(7, {});
  const Stage none{"vectors", {trial("always red", [] { return least(1, 2) == 1; })}};
  const Status why = hunt(none, all, options(), outcomes);
  ASSERT_FALSE(why);
  EXPECT_EQ(why.error().message, "vectors: every trial is red on the healthy device");
}

TEST_F(Hunt, EquivalentMutantsDoNotCount) {
  outcomes[0] = {Fate::red, "vectors", "a", "manual, 1"};
  outcomes[1] = {Fate::hung, "derived", "b", "manual, 2"};
  all[2].equivalent = "nobody can tell";
  outcomes[3] = {Fate::survived, "", "", "manual, 3"};
  EXPECT_THAT(summary(all, outcomes, {"vectors", "derived"}),
              HasSubstr("all: 16.7 % of 6 killed by vectors, 33.3 % with derived\n"));
  const std::string text = markdown(all, outcomes, {"vectors", "derived"});
  EXPECT_THAT(text, HasSubstr("| protocol | 7 | 1 | 16.7 % | 33.3 % | 1 | 3 | 4 |"));
  EXPECT_THAT(text, HasSubstr("| manual, 3 | 1 |"));
}

}  // namespace
}  // namespace fieldproof::mutants
