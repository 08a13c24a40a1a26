#include "reports/results/shard.hpp"

#include <fmt/format.h>
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

}  // namespace

std::optional<Shard> shard_of_environment() {
  const char* index = std::getenv("GTEST_SHARD_INDEX");
  const char* total = std::getenv("GTEST_TOTAL_SHARDS");
  return index && total ? sound(number(index), number(total)) : std::nullopt;
}

Status check_shard_environment() {
  const char* index = std::getenv("GTEST_SHARD_INDEX");
  const char* total = std::getenv("GTEST_TOTAL_SHARDS");
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
