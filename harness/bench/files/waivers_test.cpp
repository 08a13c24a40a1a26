#include "harness/bench/files/waivers.hpp"

#include <gmock/gmock.h>

namespace fieldproof::bench {

using results::CaseResult;
using results::Verdict;

namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

CaseResult result_of(const std::string& id, Verdict verdict, const std::string& message = "") {
  CaseResult result;
  result.id = id;
  result.verdict = verdict;
  result.message = message;
  return result;
}

CaseResult failed(const std::string& message) {
  return result_of("xgt_cnet/a/b", Verdict::fail, message);
}

std::string entry(const std::string& id, const std::string& more = "") {
  return R"({"id": ")" + id +
         R"(", "reason": "sums the wrong bytes", "owner": "kim", "text": "BCC:", "expires": "2026-12-31")" +
         more + "}";
}

std::vector<Waiver> parsed(const std::string& entries) {
  const Result<std::vector<Waiver>> waivers = parse_waivers("[" + entries + "]", "w.json");
  EXPECT_TRUE(waivers) << waivers.error().message;
  return waivers ? *waivers : std::vector<Waiver>();
}

CaseResult applied(CaseResult result, const std::string& entries,
                   const std::string& today = "2026-11-21", const std::string& firmware = "") {
  Waivers waivers(parsed(entries), today, firmware);
  waivers.apply(result);
  return result;
}

TEST(Waivers, HoldUntilTheirLastDay) {
  const CaseResult last_day =
      applied(failed("BCC: expected D6, got D7"), entry("xgt_cnet/a/b"), "2026-12-31");
  EXPECT_EQ(last_day.verdict, Verdict::xfail);
  EXPECT_THAT(last_day.notes, Contains("waived until 2026-12-31: sums the wrong bytes (kim)"));
  const CaseResult after =
      applied(failed("BCC: expected D6, got D7"), entry("xgt_cnet/a/b"), "2027-01-01");
  EXPECT_EQ(after.verdict, Verdict::fail);
  EXPECT_THAT(after.notes, Contains(HasSubstr("expired on 2026-12-31")));
  EXPECT_THAT(after.notes, Contains(HasSubstr("have its owner set a new date")));
}

TEST(Waivers, HoldForTheirFailureAlone) {
  const CaseResult other = applied(failed("no answer within 500 ms"), entry("xgt_cnet/a/b"));
  EXPECT_EQ(other.verdict, Verdict::fail);
  EXPECT_THAT(other.notes, Contains(HasSubstr("another failure, 'BCC:'")));
}

TEST(Waivers, HoldForTheirFirmwareAlone) {
  const std::string range = entry("xgt_cnet/a/b", R"(, "firmware": {"from": "1.2", "to": "1.10"})");
  EXPECT_EQ(applied(failed("BCC: x"), range, "2026-11-21", "V1.9").verdict, Verdict::xfail);
  EXPECT_EQ(applied(failed("BCC: x"), range, "2026-11-21", "1.10").verdict, Verdict::xfail);
  const CaseResult newer = applied(failed("BCC: x"), range, "2026-11-21", "1.11");
  EXPECT_EQ(newer.verdict, Verdict::fail);
  EXPECT_THAT(newer.notes, Contains(HasSubstr("for firmware 1.2 to 1.10, the device has 1.11")));
  EXPECT_EQ(applied(failed("BCC: x"), range, "2026-11-21", "1.1").verdict, Verdict::fail);
  const CaseResult unknown = applied(failed("BCC: x"), range);
  EXPECT_EQ(unknown.verdict, Verdict::fail);
  EXPECT_THAT(unknown.notes, Contains(HasSubstr("is not known; enter it in the bench file")));
}

TEST(Waivers, OneForThisFirmwareGoesBeforeOneForAnother) {
  const std::string both = entry("xgt_cnet/a/b", R"(, "firmware": {"to": "1.1"})") + "," +
                           entry("xgt_cnet/a/*", R"(, "firmware": {"from": "1.2"})");
  EXPECT_EQ(applied(failed("BCC: x"), both, "2026-11-21", "1.2").verdict, Verdict::xfail);
}

TEST(Waivers, WhatNoLongerFailsIsXpass) {
  for (Verdict verdict : {Verdict::pass, Verdict::non_strict, Verdict::marginal, Verdict::info}) {
    const CaseResult result = applied(result_of("xgt_cnet/a/b", verdict), entry("xgt_cnet/a/b"));
    EXPECT_EQ(result.verdict, Verdict::xpass);
    EXPECT_THAT(result.message, HasSubstr("remove the waiver"));
  }
  const std::string old_firmware = entry("xgt_cnet/a/b", R"(, "firmware": {"to": "1.1"})");
  EXPECT_EQ(
      applied(result_of("xgt_cnet/a/b", Verdict::pass), old_firmware, "2026-11-21", "1.2").verdict,
      Verdict::pass);
}

TEST(Waivers, WhatWasNotJudgedIsLeftAsItIs) {
  for (Verdict verdict : {Verdict::skip, Verdict::blocked, Verdict::inconclusive, Verdict::error})
    EXPECT_EQ(applied(result_of("xgt_cnet/a/b", verdict), entry("xgt_cnet/a/b")).verdict, verdict);
}

TEST(Waivers, AGlobThatCoversNoFailureIsRedAtTheEnd) {
  const std::vector<std::string> ids{"xgt_cnet/a/b", "xgt_cnet/a/c", "xgt_cnet/d/e"};
  const auto at_the_end = [&](std::vector<CaseResult> results) {
    Waivers waivers(parsed(entry("xgt_cnet/a/*")), "2026-11-21", "");
    for (CaseResult& result : results) {
      waivers.apply(result);
      EXPECT_NE(result.verdict, Verdict::xpass) << "a glob may cover cases that pass";
    }
    return waivers.superfluous(ids);
  };
  const CaseResult b = result_of("xgt_cnet/a/b", Verdict::pass),
                   c = result_of("xgt_cnet/a/c", Verdict::pass);
  const std::vector<CaseResult> red = at_the_end({b, c});
  ASSERT_EQ(red.size(), 1u);
  EXPECT_EQ(red[0].verdict, Verdict::xpass);
  EXPECT_EQ(red[0].id, "waiver/xgt_cnet/a/*");
  EXPECT_THAT(red[0].message, HasSubstr("none of the 2 cases"));
  EXPECT_THAT(at_the_end({b, result_of("xgt_cnet/a/c", Verdict::fail, "BCC: x")}), IsEmpty());
  EXPECT_THAT(at_the_end({b, c, failed("BCC: in the second repetition")}), IsEmpty());
  EXPECT_THAT(at_the_end({b}), IsEmpty()) << "the other case was not run";
  EXPECT_THAT(at_the_end({b, result_of("xgt_cnet/a/c", Verdict::blocked)}), IsEmpty());
  EXPECT_EQ(at_the_end({b, result_of("xgt_cnet/a/c", Verdict::skip)}).size(), 1u)
      << "this device cannot fail it";
}

TEST(Waivers, AGlobIsStaleWhereSomeCasesAreNeverJudged) {
  std::vector<std::string> ids;
  for (int i = 0; i < 20; ++i) ids.push_back(fmt::format("xgt_cnet/a/n{}", i));
  const auto superfluous = [&](int unjudged) {
    Waivers waivers(parsed(entry("xgt_cnet/a/*")), "2026-11-21", "");
    for (int i = 0; i < 20; ++i) {
      CaseResult one = result_of(ids[static_cast<std::size_t>(i)],
                                 i < unjudged ? Verdict::blocked : Verdict::pass);
      waivers.apply(one);
    }
    return waivers.superfluous(ids);
  };
  const std::vector<CaseResult> red = superfluous(2);
  ASSERT_EQ(red.size(), 1u);
  EXPECT_THAT(red[0].message, HasSubstr("none of the 18 cases"));
  EXPECT_THAT(superfluous(3), IsEmpty()) << "too much of it was not looked at";
}

TEST(Waivers, UnknownTargetsGetASuggestion) {
  EXPECT_THAT(unknown_targets(parsed(entry("xgt_cnet/a/b")), {"xgt_cnet/a/b"}), IsEmpty());
  EXPECT_THAT(unknown_targets(parsed(entry("xgt_cnet/a/two_wrds")),
                              {"xgt_cnet/a/b", "xgt_cnet/a/two_words"}),
              ElementsAre("no case 'xgt_cnet/a/two_wrds'; did you mean 'xgt_cnet/a/two_words'?"));
}

TEST(Waivers, BadEntriesAreNamed) {
  const auto message = [](const std::string& text) {
    const Result<std::vector<Waiver>> waivers = parse_waivers(text, "w.json");
    return waivers ? "no error" : waivers.error().message;
  };
  EXPECT_THAT(message("[{]"), HasSubstr("cannot read waivers w.json: "));
  EXPECT_THAT(message("{}"), HasSubstr("not an array"));
  EXPECT_THAT(message("[3]"), HasSubstr("entry 0: it is not an object"));
  EXPECT_THAT(message("[" + entry("a") + "," + entry("b", R"(, "ownr": "x")") + "]"),
              HasSubstr("entry 1: unknown key 'ownr'; did you mean 'owner'?"));
  EXPECT_THAT(
      message(
          R"([{"id": "a", "reason": "r", "owner": "o", "text": "t", "expires": "2026-02-30"}])"),
      HasSubstr("expires '2026-02-30' is no date"));
  EXPECT_THAT(
      message(
          R"([{"id": "a", "reason": " ", "owner": "o", "text": "t", "expires": "2026-02-01"}])"),
      HasSubstr("'reason' is empty"));
  EXPECT_THAT(message(R"([{"id": "a", "reason": "r", "text": "t", "expires": "2026-02-01"}])"),
              HasSubstr("'owner' is missing"));
  EXPECT_THAT(message(R"([{"id": "a", "reason": "r", "owner": "o", "expires": "2026-02-01"}])"),
              HasSubstr("'text' is missing"));
  EXPECT_THAT(message("[" + entry("a", R"(, "firmware": {"till": "1"})") + "]"),
              HasSubstr("unknown key 'till'"));
  EXPECT_THAT(message("[" + entry("a", R"(, "firmware": {"to": "latest"})") + "]"),
              HasSubstr("firmware.to 'latest' has no number"));
  EXPECT_THAT(message("[" + entry("a", R"(, "firmware": "1.4")") + "]"),
              HasSubstr("'firmware' is a range: {"));
  EXPECT_THAT(message("[" + entry("a", R"(, "firmware": {"to": 1.4})") + "]"),
              HasSubstr("firmware.to is not a text"));
  EXPECT_THAT(
      message(R"([{"id": "a", "reason": "r", "owner": 7, "text": "t", "expires": "2026-02-01"}])"),
      HasSubstr("entry 0: 'owner' is not a text: who answers for it"));
  EXPECT_THAT(message("[" + entry("a") + "," + entry("a") + "]"),
              HasSubstr("entry 1: 'a' is waived twice"));
}

TEST(Versions, AreComparedByTheirNumbers) {
  EXPECT_LT(compare_versions("1.9", "V1.10"), 0);
  EXPECT_GT(compare_versions("2", "1.99"), 0);
  EXPECT_EQ(compare_versions("V1.2", "1.2.0"), 0);
  EXPECT_LT(compare_versions("", "1"), 0);
}

}  // namespace
}  // namespace fieldproof::bench
