#include "harness/vectors/link_names.hpp"

#include <gmock/gmock.h>

namespace fieldproof::vectors {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Step step(Step::Kind kind, const std::string& on = {}) {
  Step one;
  one.kind = kind;
  one.on = on;
  return one;
}
Step open(const std::string& name, const std::string& protocol = {}) {
  Step one = step(Step::Kind::open, name);
  one.link.protocol = protocol;
  return one;
}
Step close(Closing how, const std::string& on = {}) {
  Step one = step(Step::Kind::close, on);
  one.closing = how;
  return one;
}
const Step send = step(Step::Kind::send), expect = step(Step::Kind::expect),
           ending = step(Step::Kind::expect_close);

Case case_of(std::vector<Step> steps, bool client = false) {
  Case one;
  one.protocol = "some-protocol";
  one.steps = std::move(steps);
  if (client) one.config["role"] = "client";
  return one;
}

/// The link of each step; the first error ends the list.
std::vector<std::string> links(const Case& source, bool network = true) {
  LinkNames names(source, network);
  std::vector<std::string> found;
  for (const Step& one : source.steps) {
    const Result<std::string> name = names.next(one);
    found.push_back(name ? *name : name.error().message);
    if (!name) break;
  }
  return found;
}

TEST(LinkNames, ACaseThatOpensNoneUsesTheImplicitOne) {
  const Case source = case_of({send, expect, close(Closing::fin), ending});
  EXPECT_THAT(links(source), ElementsAre("", "", "", ""));
  EXPECT_TRUE(LinkNames(source, true).implicit());
  EXPECT_FALSE(LinkNames(source, false).implicit()) << "a line is there anyway";
}

TEST(LinkNames, TheOnlyOpenLinkNeedsNoName) {
  EXPECT_THAT(links(case_of({open("a"), send, close(Closing::rst), open("b"), send})),
              ElementsAre("a", "a", "a", "b", "b"));
}

TEST(LinkNames, ALinkThatTheBenchHasClosedIsStillHeard) {
  EXPECT_THAT(links(case_of({open("a"), close(Closing::fin), expect, ending})),
              ElementsAre("a", "a", "a", "a"));
  EXPECT_THAT(links(case_of({open("a"), close(Closing::fin), open("b"), send, ending})),
              ElementsAre("a", "a", "b", "b", "b"));
}

TEST(LinkNames, OfSeveralOneMustBeNamed) {
  EXPECT_THAT(links(case_of({open("a"), open("b"), step(Step::Kind::send, "b"), send})).back(),
              HasSubstr("must say \"on\" which; open: 'a', 'b'"));
}

TEST(LinkNames, WhatIsNotOpenIsRefused) {
  EXPECT_THAT(links(case_of({open("a"), step(Step::Kind::send, "b")})).back(),
              HasSubstr("no link 'b' is open; open: 'a'"));
  EXPECT_THAT(links(case_of({open("a"), close(Closing::fin), step(Step::Kind::send, "a")})).back(),
              HasSubstr("link 'a' is closed"));
  EXPECT_THAT(links(case_of({open("a"), ending, expect})).back(), HasSubstr("no link is open"));
  EXPECT_THAT(links(case_of({open("a"), open("a")})).back(), HasSubstr("open already"));
  EXPECT_THAT(links(case_of({step(Step::Kind::wait, "a")})).back(), HasSubstr("uses no link"));
}

TEST(LinkNames, ALineNeverOpensNorCloses) {
  EXPECT_THAT(links(case_of({send, expect}), false), ElementsAre("", ""));
  for (const Step& one : {open("a"), close(Closing::fin), ending})
    EXPECT_THAT(links(case_of({one}), false).back(),
                HasSubstr("some-protocol runs on a serial line, which"));
  EXPECT_EQ(check_links(case_of({send, ending}), false).error().message.substr(0, 9), "steps[1]:");
}

TEST(LinkNames, ADatagramHasNoPause) {
  Step udp = open("a"), cut = send;
  udp.link.transport = Transport::udp;
  cut.frames.push_back({"", "01 ~0ms 02", *notation::parse_notation("01 ~0ms 02"), {}});
  EXPECT_THAT(links(case_of({udp, send, cut})),
              ElementsAre("a", "a", HasSubstr("link 'a' carries datagrams")));
  EXPECT_THAT(links(case_of({open("a"), cut})), ElementsAre("a", "a"));
}

TEST(LinkNames, AServiceOfTheSameDeviceIsListed) {
  Case source = case_of({open("a", "other"), step(Step::Kind::send, "a"), send});
  EXPECT_THAT(links(source, false).back(), HasSubstr("list it in given.config.services"));
  source.config["services"]["other"] = nlohmann::json::object();
  EXPECT_THAT(links(source, false), ElementsAre("a", "a", "")) << "the line goes on";
}

TEST(LinkNames, TheSecondChannelIsAlwaysThere) {
  const Step aux = step(Step::Kind::send, "aux");
  EXPECT_THAT(links(case_of({aux, send}), false), ElementsAre("aux", ""));
  EXPECT_THAT(links(case_of({step(Step::Kind::close, "aux")}), false).back(),
              HasSubstr("which neither side can close"));
}

TEST(LinkNames, ADeviceThatAsksOpensItself) {
  EXPECT_THAT(links(case_of({expect, send, close(Closing::rst), expect}, true)),
              ElementsAre("", "", "", ""));
  EXPECT_THAT(links(case_of({expect, step(Step::Kind::expect_open, "a"), expect,
                             step(Step::Kind::expect_open, "b"), step(Step::Kind::send, "b"), send},
                            true)),
              ElementsAre("", "a", "a", "b", "b", HasSubstr("must say \"on\" which")));
  EXPECT_THAT(links(case_of({step(Step::Kind::expect_open, "a")})).back(),
              HasSubstr("none but a case of role client"));
  EXPECT_THAT(links(case_of({open("a")}, true)).back(), HasSubstr("expect_open"));
}

}  // namespace
}  // namespace fieldproof::vectors
