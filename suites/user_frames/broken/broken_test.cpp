// The suite against broken ports: each fault must turn its case red, and the healthy port must pass
// them all. Everything runs in process: user-defined frames have no request that reads memory, so
// that no other endpoint sees what is stored.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "harness/bench/bench.hpp"
#include "harness/endpoints/emulator.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/user_frames/broken/faults.hpp"
#include "suites/user_frames/protocol.hpp"

namespace fieldproof::user_frames_broken {

using results::CaseResult;
using results::Verdict;
using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

/// Without the cases of P2P blocks: suites/p2p/broken.
const vectors::VectorSet& vectors() {
  static const vectors::VectorSet set = [] {
    vectors::VectorSet all = vectors::load_vectors(FIELDPROOF_SOURCE_DIR "/vectors/user_frames");
    std::erase_if(all.cases, [](const Case& one) { return one.config.contains("p2p"); });
    return all;
  }();
  return set;
}

CaseResult run(const Case& source, const Behaviour& behaviour) {
  endpoints::EmulatorEndpoint endpoint({"emulator", "", {}},
                                       [&](std::string_view model, const nlohmann::json& config) {
                                         return make_broken_port(behaviour, model, config);
                                       });
  bench::BenchOptions options;
  options.profile.name = "emulator";
  options.profile.protocols = {"user-frames"};
  bench::Bench bench(endpoint, user_frames_suite::protocol(), options);
  return bench.run(source);
}

/// The message, and the fields that differ.
std::string report(const CaseResult& result) {
  std::string text = result.id + ": " + result.message;
  for (const results::Difference& one : result.differences) text += "; " + one.field;
  return text;
}

class TheSuite : public testing::TestWithParam<Fault> {};

TEST_P(TheSuite, Catches) {
  const Fault& fault = GetParam();
  const auto one = std::ranges::find(vectors().cases, fault.caught_by, &Case::id);
  const bool known = one != vectors().cases.end();
  const CaseResult result = known ? run(*one, fault.make) : CaseResult{};
  if (known && result.verdict == Verdict::fail &&
      report(result).find(fault.message) != std::string::npos)
    return fmt::print("{:<28} {}\n", fault.name, report(result));
  std::string red;
  for (const Case& other : vectors().cases)
    if (const CaseResult found = run(other, fault.make); found.verdict == Verdict::fail)
      red += "\n  " + report(found);
  ADD_FAILURE() << fault.caught_by
                << (known ? " does not catch it: " + report(result) : " is no case")
                << "\nred are:" << red;
}

INSTANTIATE_TEST_SUITE_P(Broken, TheSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyPort, PassesTheWholeSuite) {
  EXPECT_THAT(vectors().problems, testing::IsEmpty());
  std::size_t passed = 0;
  for (const Case& one : vectors().cases) {
    const CaseResult result = run(one, {});
    EXPECT_TRUE(result.verdict == Verdict::pass || result.verdict == Verdict::info)
        << report(result);
    passed += result.verdict == Verdict::pass;
  }
  EXPECT_GT(passed, 200u);
}

TEST(UserFrameFacts, HoldInTheTables) {
  for (const Case& one : vectors().tables) {
    const Status fact = user_frames_suite::protocol().check_fact(one.facts);
    EXPECT_TRUE(fact) << one.id << ": " << fact.error().message;
  }
}

TEST(FaultTable, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const Fault& fault : faults()) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults().size(), 40u);
}

}  // namespace
}  // namespace fieldproof::user_frames_broken
