#include "reports/compare/merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "reports/testdata/samples.hpp"

namespace fieldproof::compare {

using results::RunInfo;
using results::Verdict;

namespace {

using samples::with;
using testing::ElementsAre;
using testing::HasSubstr;

ResultFile file(const std::string& path, const std::string& shard,
                const std::vector<results::CaseResult>& results) {
  ResultFile one{path, samples::run_info(), samples::run_end(0), results};
  if (!shard.empty()) one.run.properties["shard"] = shard;
  return one;
}

std::string refusal(const ResultFile& a, const ResultFile& b) {
  const Result<MergedRun> merged = merge_results({a, b});
  return merged ? "merged" : merged.error().message;
}

const ResultFile first_shard =
    file("a", "1/2", {samples::with(Verdict::pass, "x/1"), samples::with(Verdict::fail, "x/3")});
const ResultFile second_shard = file("b", "2/2", {samples::with(Verdict::pass, "x/2")});

TEST(Merge, TakesEachResultOnce) {
  const Result<MergedRun> merged = merge_results({first_shard, second_shard});
  ASSERT_TRUE(merged) << merged.error().message;
  std::vector<std::string> ids;
  for (const results::CaseResult& one : merged->results) ids.push_back(one.id);
  EXPECT_THAT(ids, ElementsAre("x/1", "x/3", "x/2"));
  EXPECT_EQ(merged->run.properties.at("shards"), "1/2, 2/2");
  EXPECT_EQ(merged->run.properties.at("merged"), "a, b");
  EXPECT_EQ(merged->run.properties.at("seed"), "7");
  EXPECT_THAT(merged->troubles, testing::IsEmpty());
  EXPECT_EQ(merged->seconds, 2.25);
}

TEST(Merge, RefusesWhatIsNotOfOneRun) {
  const auto changed = [](auto change) {
    ResultFile other = second_shard;
    change(other.run);
    return refusal(first_shard, other);
  };
  EXPECT_EQ(changed([](RunInfo& run) { run.vectors_hash = "c3d4"; }),
            "cannot merge b with a: the vectors differ: c3d4 and a1b2; run all parts with the same "
            "vectors");
  EXPECT_THAT(changed([](RunInfo& run) { run.tool_version = "0.2.0"; }),
              HasSubstr("the tool version differs: 0.2.0 and 0.1.0"));
  EXPECT_THAT(changed([](RunInfo& run) { run.profile = "xbm-s"; }),
              HasSubstr("the profile differs"));
  EXPECT_THAT(changed([](RunInfo& run) { run.properties["gate"] = "strict"; }),
              HasSubstr("the gate differs"));
  EXPECT_THAT(changed([](RunInfo& run) { run.properties["selection"] = "3 cases"; }),
              HasSubstr("the selection differs: 3 cases and none"));
  EXPECT_THAT(changed([](RunInfo& run) { run.properties["shard"] = "2/3"; }),
              HasSubstr("the shards differ: 3 and 2"));
  EXPECT_THAT(changed([](RunInfo& run) { run.properties.erase("shard"); }),
              HasSubstr("the shards differ: none and 2"));
  EXPECT_THAT(changed([](RunInfo& run) { run.properties["shard"] = "1/2"; }),
              HasSubstr("both are shard 1/2"));
  EXPECT_THAT(changed([](RunInfo& run) { run.hashes["tool"] = "00"; }),
              HasSubstr("the hashed files differ: tool 00 and none"));
  EXPECT_THAT(changed([](RunInfo& run) { run.vectors_hash = ""; }),
              HasSubstr("cannot merge b: it does not say which vectors it is of"));
}

TEST(Merge, OneCaseHasOneVerdict) {
  const ResultFile a = file("a", "", {samples::with(Verdict::pass, "x/1")}),
                   same = file(
                       "b", "",
                       {samples::with(Verdict::pass, "x/1"), samples::with(Verdict::pass, "x/2")});
  EXPECT_EQ(merge_results({a, same})->results.size(), 2u);
  EXPECT_THAT(refusal(a, file("b", "", {samples::with(Verdict::fail, "x/1")})),
              HasSubstr("cannot merge b with a: x/1 is FAIL in the one and PASS in the other"));
}

TEST(Merge, MissingKilledAndTroubledShardsAreNamed) {
  ResultFile killed = second_shard, troubled = second_shard;
  killed.end.reset();
  troubled.end->trouble = "the port failed";
  EXPECT_THAT(merge_results({file("a", "1/4", {}), file("c", "3/4", {})})->troubles,
              ElementsAre("shards 2/4, 4/4 are missing"));
  EXPECT_THAT(merge_results({first_shard, killed})->troubles,
              ElementsAre("b: the run was killed after 1 results"));
  EXPECT_THAT(merge_results({first_shard, troubled})->troubles, ElementsAre("b: the port failed"));
}

TEST(Merge, DevicesAreKeptApart) {
  ResultFile a = first_shard, b = second_shard;
  a.run.identity = {.name = "left",
                    .maker = "LS",
                    .model = {},
                    .serial = "1",
                    .firmware = {},
                    .operator_name = {},
                    .notes = {},
                    .fingerprint = {},
                    .fingerprint_found = {}};
  b.run.identity = a.run.identity;
  b.run.identity.name = "right";
  b.run.identity.serial = "2";
  const Result<MergedRun> merged = merge_results({a, b});
  ASSERT_TRUE(merged);
  ASSERT_EQ(merged->run.duts.size(), 2u);
  EXPECT_EQ(merged->run.duts[1].identity.serial, "2");
  EXPECT_EQ(merged->run.identity.maker, "LS");
  EXPECT_EQ(merged->run.identity.serial, "");
  EXPECT_EQ(merged->results.front().dut, "left");
  EXPECT_EQ(merged->results.back().dut, "right");
}

}  // namespace
}  // namespace fieldproof::compare
