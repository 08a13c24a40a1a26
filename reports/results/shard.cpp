#include "reports/results/shard.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace fieldproof::results {

namespace {

std::optional<int> number(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<Shard> sound(std::optional<int> index, std::optional<int> total) {
  if (!index || !total || *index < 0 || *index >= *total) return std::nullopt;
  return Shard{*index, *total};
}

std::optional<int> variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? number(value) : std::nullopt;
}

/// SLURM_ARRAY_TASK_ID need not begin at 0, nor go up by one (--array=1-7:2).
Shard of_job_array() {
  const std::optional<int> id = variable("SLURM_ARRAY_TASK_ID");
  const int step = std::max(1, variable("SLURM_ARRAY_TASK_STEP").value_or(1));
  const int index = (id.value_or(0) - variable("SLURM_ARRAY_TASK_MIN").value_or(0)) / step;
  return sound(id ? std::optional(index) : std::nullopt, variable("SLURM_ARRAY_TASK_COUNT"))
      .value_or(Shard{});
}

/// --array=1,3,7: which of them a task is, nobody says.
bool has_gaps() {
  const int count = variable("SLURM_ARRAY_TASK_COUNT").value_or(1);
  const int step = std::max(1, variable("SLURM_ARRAY_TASK_STEP").value_or(1));
  const std::optional<int> first = variable("SLURM_ARRAY_TASK_MIN");
  const std::optional<int> last = variable("SLURM_ARRAY_TASK_MAX");
  return variable("SLURM_ARRAY_TASK_ID") && first && last && count > 1 &&
         (*last - *first) / step + 1 != count;
}

Shard of_tasks() {
  const std::optional<int> step = variable("SLURM_STEP_NUM_TASKS");
  return sound(variable("SLURM_PROCID"), step ? step : variable("SLURM_NTASKS")).value_or(Shard{});
}

/// Each task of each job of an array is one.
std::optional<Shard> of_slurm() {
  const Shard job = of_job_array(), task = of_tasks();
  const Shard all{job.index * task.total + task.index, job.total * task.total};
  return all.total > 1 ? std::optional(all) : std::nullopt;
}

}  // namespace

std::optional<Shard> shard_of_environment() {
  const char* index = std::getenv("GTEST_SHARD_INDEX");
  const char* total = std::getenv("GTEST_TOTAL_SHARDS");
  if (!index && !total) return of_slurm();
  return index && total ? sound(number(index), number(total)) : std::nullopt;
}

void hand_to_googletest(const Shard& shard) {
  ::setenv("GTEST_TOTAL_SHARDS", std::to_string(shard.total).c_str(), 1);
  ::setenv("GTEST_SHARD_INDEX", std::to_string(shard.index).c_str(), 1);
}

Status check_shard_environment() {
  const char* index = std::getenv("GTEST_SHARD_INDEX");
  const char* total = std::getenv("GTEST_TOTAL_SHARDS");
  if (!index && !total && has_gaps())
    return fail(
        "the job array has gaps (--array=1,3,7), so which shard a task is cannot be told; give it "
        "one step (--array=0-2), or set GTEST_SHARD_INDEX and GTEST_TOTAL_SHARDS");
  if ((!index && !total) || shard_of_environment()) return ok();
  return fail(
      fmt::format("GTEST_SHARD_INDEX={} of GTEST_TOTAL_SHARDS={} is no shard; set both, the index "
                  "from 0 to one "
                  "less than the total",
                  index ? index : "(not set)", total ? total : "(not set)"));
}

std::string to_string(const Shard& shard) {
  return fmt::format("{}/{}", shard.index + 1, shard.total);
}

std::optional<Shard> parse_shard(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  const std::optional<int> index = number(text.substr(0, slash));
  return sound(index ? std::optional(*index - 1) : std::nullopt, number(text.substr(slash + 1)));
}

}  // namespace fieldproof::results
