// Which part of a selection a run has done: GoogleTest deals the cases out by GTEST_TOTAL_SHARDS
// and GTEST_SHARD_INDEX; where they are not set, the tasks of a Slurm job array, or of an srun, are
// the shards.
#pragma once

#include <compare>
#include <optional>
#include <string>
#include <string_view>

#include "src/base/result.hpp"

namespace fieldproof::results {

struct Shard {
  int index = 0;  // from 0
  int total = 1;

  auto operator<=>(const Shard&) const = default;
};

/// What the environment says is a shard, or nothing: GoogleTest would end the tool in the middle.
Status check_shard_environment();
/// Nothing where the environment asks for none.
std::optional<Shard> shard_of_environment();
/// Makes it GoogleTest's.
void hand_to_googletest(const Shard& shard);

/// "2/3", counted from 1.
std::string to_string(const Shard& shard);
std::optional<Shard> parse_shard(std::string_view text);

}  // namespace fieldproof::results
