#include "harness/vectors/links.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "harness/vectors/broken.hpp"

namespace fieldproof::vectors {
namespace {

using Kind = Step::Kind;
using testing::ElementsAre;
using testing::HasSubstr;

Step step(Kind kind, const std::string& on = "") {
  Step result;
  result.kind = kind;
  result.on = on;
  return result;
}

Step close(Closing how, const std::string& on = "") {
  Step result = step(Kind::close, on);
  result.closing = how;
  return result;
}

/// The links of all steps; what is wrong.
std::vector<std::string> resolved(std::vector<Step> steps) {
  Links links(std::ranges::any_of(
      steps, [](const Step& one) { return !one.on.empty() || one.kind == Kind::open; }));
  std::vector<std::string> names;
  try {
    for (Step& one : steps) {
      links.resolve(one);
      names.push_back(one.on);
    }
  } catch (const Broken& broken) {
    names.push_back(broken.what());
  }
  return names;
}

TEST(Links, WhereNothingIsOpenedThereIsOneWithoutName) {
  EXPECT_THAT(resolved({step(Kind::send), step(Kind::expect), close(Closing::rst)}),
              ElementsAre("", "", ""));
}

TEST(Links, TheOnlyOneThatIsOpenIsMeant) {
  EXPECT_THAT(
      resolved({step(Kind::open, "a"), step(Kind::send), step(Kind::wait), close(Closing::fin),
                step(Kind::expect_close, "a"), step(Kind::open, "b"), step(Kind::send)}),
      ElementsAre("a", "a", "", "a", "a", "b", "b"));
}

TEST(Links, OneOfSeveralIsNamed) {
  EXPECT_THAT(resolved({step(Kind::open, "a"), step(Kind::open, "b"), step(Kind::send, "b"),
                        step(Kind::expect)}),
              ElementsAre("a", "b", "b", "say on which link this is (\"on\"); open: 'a', 'b'"));
}

TEST(Links, OneThatIsNotOpenIsAnError) {
  EXPECT_THAT(resolved({step(Kind::send, "a")}), ElementsAre("no link 'a' is open; none is open"));
  EXPECT_THAT(resolved({step(Kind::open, "a"), close(Closing::rst), step(Kind::send, "a")}),
              ElementsAre("a", "a", HasSubstr("no link 'a' is open")));
  EXPECT_THAT(resolved({step(Kind::send), step(Kind::open, "a")}),
              ElementsAre(HasSubstr("say on which link this is")));
  EXPECT_THAT(resolved({step(Kind::open, "a"), step(Kind::expect_close), step(Kind::send)}),
              ElementsAre("a", "a", HasSubstr("open: 'a' (ended)")));
}

TEST(Links, ANameIsFreeAgainAfterAReset) {
  EXPECT_THAT(resolved({step(Kind::open, "a"), close(Closing::vanish), step(Kind::open, "a")}),
              ElementsAre("a", "a", "a"));
  EXPECT_THAT(resolved({step(Kind::open, "a"), step(Kind::open, "a")}),
              ElementsAre("a", HasSubstr("a link 'a' is open already")));
}

TEST(Links, WhatIsOnNoLinkNamesNone) {
  EXPECT_THAT(resolved({step(Kind::open, "a"), step(Kind::check, "a")}),
              ElementsAre("a", HasSubstr("has no meaning in this step")));
}

TEST(Links, KnowWhereDatagramsGo) {
  Step open = step(Kind::open, "a");
  open.link.transport = Transport::udp;
  Links links(true);
  links.resolve(open);
  EXPECT_TRUE(links.is_datagram("a"));
  EXPECT_FALSE(links.is_datagram("b"));
}

}  // namespace
}  // namespace fieldproof::vectors
