#include "reports/results/shard.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <string>

namespace fieldproof::results {
namespace {

TEST(Shard, IsCountedFromOneInText) {
  EXPECT_EQ(to_string(Shard{0, 3}), "1/3");
  EXPECT_EQ(parse_shard("3/3"), (Shard{2, 3}));
  for (const char* wrong : {"", "1", "0/3", "4/3", "1/0", "-1/3", "1/3 ", "a/b", "1/3, 2/3"})
    EXPECT_EQ(parse_shard(wrong), std::nullopt) << wrong;
}

using Environment = std::map<std::string, std::string>;

/// Calls `read` where these variables alone are set.
template <typename Read>
auto with(const Environment& variables, const Read& read) {
  const std::string names[] = {"GTEST_TOTAL_SHARDS",   "GTEST_SHARD_INDEX",
                               "SLURM_ARRAY_TASK_ID",  "SLURM_ARRAY_TASK_COUNT",
                               "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_STEP",
                               "SLURM_ARRAY_TASK_MAX", "SLURM_PROCID",
                               "SLURM_NTASKS",         "SLURM_STEP_NUM_TASKS"};
  Environment before;
  for (const std::string& name : names) {
    if (const char* value = std::getenv(name.c_str())) before[name] = value;
    ::unsetenv(name.c_str());
  }
  for (const auto& [name, value] : variables) ::setenv(name.c_str(), value.c_str(), 1);
  const auto result = read();
  for (const std::string& name : names) ::unsetenv(name.c_str());
  for (const auto& [name, value] : before) ::setenv(name.c_str(), value.c_str(), 1);
  return result;
}

std::optional<Shard> shard_of(const Environment& variables) {
  return with(variables, shard_of_environment);
}
bool sound_environment(const Environment& variables) {
  return with(variables, [] { return bool(check_shard_environment()); });
}

TEST(Shard, OfAJobArray) {
  const Environment third{{"SLURM_ARRAY_TASK_ID", "5"},  {"SLURM_ARRAY_TASK_COUNT", "4"},
                          {"SLURM_ARRAY_TASK_MIN", "1"}, {"SLURM_ARRAY_TASK_STEP", "2"},
                          {"SLURM_NTASKS", "1"},         {"SLURM_PROCID", "0"}};
  EXPECT_EQ(shard_of(third), (Shard{2, 4}));
  EXPECT_EQ(shard_of({{"SLURM_ARRAY_TASK_ID", "0"}, {"SLURM_ARRAY_TASK_COUNT", "1"}}),
            std::nullopt);
}

TEST(Shard, OfAnArrayWithGapsCannotBeTold) {
  const Environment gaps{{"SLURM_ARRAY_TASK_ID", "7"},
                         {"SLURM_ARRAY_TASK_COUNT", "3"},
                         {"SLURM_ARRAY_TASK_MIN", "1"},
                         {"SLURM_ARRAY_TASK_MAX", "7"},
                         {"SLURM_ARRAY_TASK_STEP", "1"}};
  EXPECT_FALSE(sound_environment(gaps));
  Environment whole = gaps;
  whole["SLURM_ARRAY_TASK_COUNT"] = "7";
  EXPECT_TRUE(sound_environment(whole));
}

TEST(Shard, OfTheTasksOfAStep) {
  EXPECT_EQ(shard_of({{"SLURM_PROCID", "1"}, {"SLURM_NTASKS", "3"}}), (Shard{1, 3}));
  EXPECT_EQ(shard_of({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "8"}, {"SLURM_STEP_NUM_TASKS", "1"}}),
            std::nullopt)
      << "a step of one task in a larger allocation is all there is";
}

TEST(Shard, OfTheTasksOfEachJobOfAnArray) {
  EXPECT_EQ(shard_of({{"SLURM_ARRAY_TASK_ID", "1"},
                      {"SLURM_ARRAY_TASK_COUNT", "2"},
                      {"SLURM_PROCID", "2"},
                      {"SLURM_NTASKS", "3"}}),
            (Shard{5, 6}));
}

TEST(Shard, WhatTheUserSetsComesBeforeSlurm) {
  EXPECT_EQ(shard_of({{"GTEST_TOTAL_SHARDS", "2"},
                      {"GTEST_SHARD_INDEX", "0"},
                      {"SLURM_PROCID", "1"},
                      {"SLURM_NTASKS", "3"}}),
            (Shard{0, 2}));
}

}  // namespace
}  // namespace fieldproof::results
