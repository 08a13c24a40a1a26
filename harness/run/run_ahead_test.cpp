#include "harness/run/run_ahead.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

namespace fieldproof::run {
namespace {

using results::CaseResult;
using vectors::Case;

std::vector<Case> cases_named(int count) {
  std::vector<Case> cases(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) cases[static_cast<std::size_t>(i)].id = std::to_string(i);
  return cases;
}

std::optional<CaseResult> named(const Case& source) {
  CaseResult result;
  result.id = source.id;
  return result;
}

/// Asks for each and takes all.
std::vector<std::string> taken(RunAhead& ahead, const std::vector<Case>& cases) {
  std::vector<std::string> ids;
  const RunAhead::Take take = [&](RunAhead::Outcome outcome) {
    ids.push_back(outcome.result ? outcome.result->id : "not " + outcome.source->id);
    return true;
  };
  for (const Case& one : cases) EXPECT_TRUE(ahead.ask(one, 0, take));
  EXPECT_TRUE(ahead.finish(take));
  return ids;
}

std::vector<std::string> ids_of(const std::vector<Case>& cases) {
  std::vector<std::string> ids;
  for (const Case& one : cases) ids.push_back(one.id);
  return ids;
}

TEST(RunAhead, GivesEachResultInTheOrderInWhichItWasAsked) {
  const std::vector<Case> cases = cases_named(1000);
  RunAhead ahead({named, named, named});
  EXPECT_EQ(taken(ahead, cases), ids_of(cases));
}

TEST(RunAhead, ASlowThreadDoesNotChangeTheOrder) {
  const std::vector<Case> cases = cases_named(200);
  std::atomic<int> others{0};
  const auto slow = [&](const Case& source) {
    others.wait(0);  // until another thread has done something
    return named(source);
  };
  const auto quick = [&](const Case& source) {
    ++others;
    others.notify_all();
    return named(source);
  };
  RunAhead ahead({slow, quick});
  EXPECT_EQ(taken(ahead, cases), ids_of(cases));
}

TEST(RunAhead, WhatAThreadCannotRunOrThrowsAtIsGivenWithoutAResult) {
  const std::vector<Case> cases = cases_named(3);
  RunAhead ahead({[](const Case& source) -> std::optional<CaseResult> {
    if (source.id == "0") return std::nullopt;
    if (source.id == "1") throw std::runtime_error("broken");
    return named(source);
  }});
  EXPECT_THAT(taken(ahead, cases), testing::ElementsAre("not 0", "not 1", "2"));
}

TEST(RunAhead, WhoWantsNoMoreGetsNoMore) {
  const std::vector<Case> cases = cases_named(1000);
  RunAhead ahead({named, named});
  std::vector<std::string> ids;
  const RunAhead::Take take = [&](RunAhead::Outcome outcome) {
    ids.push_back(outcome.source->id);
    return ids.size() < 5;
  };
  for (const Case& one : cases)
    if (!ahead.ask(one, 0, take)) break;
  EXPECT_EQ(ids, (std::vector<std::string>{"0", "1", "2", "3", "4"}));
}

TEST(RunAhead, RunsNoFurtherAheadThanItsMemoryIsBounded) {
  const std::vector<Case> cases = cases_named(10'000);
  std::atomic<std::size_t> run{0};
  RunAhead ahead({[&](const Case& source) {
    ++run;
    return named(source);
  }});
  std::size_t taken = 0, furthest = 0;
  const RunAhead::Take take = [&](const RunAhead::Outcome&) {
    furthest = std::max(furthest, run - ++taken);
    return true;
  };
  for (const Case& one : cases) ahead.ask(one, 0, take);
  ahead.finish(take);
  EXPECT_EQ(taken, cases.size());
  EXPECT_LE(furthest, 200u);
}

}  // namespace
}  // namespace fieldproof::run
