// The suite against broken devices in this process, in simulated time: one case against one device,
// and what holds of every table of faults. For tests.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "harness/vectors/loader.hpp"
#include "suites/broken/fault.hpp"
#include "suites/broken/run_in_process.hpp"

namespace fieldproof::broken {

using Cases = std::vector<vectors::Case>;

/// The cases of vectors/ that match `filter` ("modbus_tcp/*") and for which `concerns` holds.
inline Cases cases_of(const std::string& filter, bool (*concerns)(const vectors::Case&)) {
  vectors::VectorSet set =
      vectors::load_vectors(FIELDPROOF_SOURCE_DIR "/vectors", {suites::protocols(), filter});
  EXPECT_THAT(set.problems, testing::IsEmpty());
  std::erase_if(set.cases, [&](const vectors::Case& one) { return !concerns(one); });
  return std::move(set.cases);
}

/// A case against a new device of `model` that `make` makes of this behaviour.
template <typename Behaviour, typename Make>
auto against(const char* model, Make make, const Behaviour& behaviour) {
  return [=](const vectors::Case& source) {
    const auto of_behaviour = [&](std::string_view of, const nlohmann::json& config) {
      return make(behaviour, of, config);
    };
    return run_in_process(source, model, of_behaviour, bare_profile(source));
  };
}

/// The message, and the fields that differ.
inline std::string report(const results::CaseResult& result) {
  std::string text = result.id + ": " + result.message;
  for (const results::Difference& one : result.differences) text += "; " + one.field;
  return text;
}

/// The case of the table must turn red, and its report must name the fault; else all cases that
/// `run` sees fail are told. `run`: a case against the device with this fault.
template <typename Make, typename Run>
void expect_caught(const FaultOf<Make>& fault, const Cases& cases, Run run) {
  const auto one = std::ranges::find(cases, fault.caught_by, &vectors::Case::id);
  const bool known = one != cases.end();
  const results::CaseResult result = known ? run(*one) : results::CaseResult{};
  const std::string told = report(result);
  if (known && turns_red(*one, result.verdict) && told.find(fault.message) != std::string::npos)
    return fmt::print("{:<34} {}\n", fault.name, told);
  std::string red;
  for (const vectors::Case& other : cases)
    if (const results::CaseResult found = run(other); found.verdict == results::Verdict::fail)
      red += "\n  " + report(found);
  ADD_FAILURE() << fault.caught_by << (known ? " does not catch it: " + told : " is no case")
                << "\nred are:" << red;
}

/// Against the device without a fault no case fails, and more than `enough` pass.
template <typename Run>
void expect_healthy(const Cases& cases, std::size_t enough, Run run) {
  std::size_t passed = 0;
  for (const vectors::Case& one : cases) {
    const results::CaseResult result = run(one);
    EXPECT_TRUE(result.verdict == results::Verdict::pass ||
                result.verdict == results::Verdict::info)
        << report(result);
    passed += result.verdict == results::Verdict::pass;
  }
  EXPECT_GT(passed, enough);
  fmt::print("{:<34} {} of {} cases pass\n", "none", passed, cases.size());
}

template <typename Make>
void expect_unique_names(const std::vector<FaultOf<Make>>& faults, std::size_t at_least) {
  std::map<std::string_view, int> names;
  for (const FaultOf<Make>& fault : faults) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults.size(), at_least);
}

}  // namespace fieldproof::broken
