// The suite against broken P2P clients: each fault must turn its case red, and the healthy client
// must pass them all. Everything runs in process: what a client saves and shows no request reads,
// so that the bench needs its memory.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "harness/bench/bench.hpp"
#include "harness/endpoints/emulator.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/p2p/broken/faults.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::p2p_broken {

using results::CaseResult;
using results::Verdict;
using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

using Cases = std::vector<Case>;

std::string folder_of(std::string_view id) { return std::string(id.substr(0, id.find('/'))); }

/// A client, without the frame monitor, which stands outside of it; or a port with UDATA
/// instructions, not a modem.
bool concerns(const Case& one) {
  if (one.protocol == "udata")
    return one.config.contains("instructions") && !one.config.value("monitor", false);
  return vectors::is_client_case(one) && !one.config.value("monitor", false);
}

/// The cases of a folder that concern the faults here.
const Cases& cases(const std::string& folder) {
  static std::map<std::string, Cases> known;
  const auto [found, is_new] = known.try_emplace(folder);
  if (!is_new) return found->second;
  const vectors::VectorSet set =
      vectors::load_vectors(FIELDPROOF_SOURCE_DIR "/vectors", {suites::protocols(), folder + "/*"});
  EXPECT_THAT(set.problems, testing::IsEmpty());
  std::ranges::copy_if(set.cases, std::back_inserter(found->second), concerns);
  return found->second;
}

/// That of a case; user frames name theirs themselves.
std::string model_of(const Case& one) {
  if (one.protocol == "user-frames") return "";
  const bool any = one.models.empty() || std::ranges::find(one.models, "xbc-h") != one.models.end();
  return any ? "xbc-h" : one.models.front();
}

CaseResult run(const Case& source, const Behaviour& behaviour) {
  const harness::Protocol& protocol = *suites::protocols().find(source.protocol);
  endpoints::EmulatorEndpoint endpoint({"emulator", model_of(source), {}},
                                       [&](std::string_view model, const nlohmann::json& config) {
                                         return make_broken_client(behaviour, source.protocol,
                                                                   model, config);
                                       });
  bench::BenchOptions options;
  options.profile.name = "emulator";
  options.profile.protocols = {source.protocol};
  bench::Bench bench(endpoint, protocol, options);
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
  const Cases& all = cases(folder_of(fault.caught_by));
  const auto one = std::ranges::find(all, fault.caught_by, &Case::id);
  const bool known = one != all.end();
  const CaseResult result = known ? run(*one, fault.make()) : CaseResult{};
  if (known && result.verdict == Verdict::fail &&
      report(result).find(fault.message) != std::string::npos)
    return fmt::print("{:<28} {}\n", fault.name, report(result));
  std::string red;
  for (const Case& other : all)
    if (const CaseResult found = run(other, fault.make()); found.verdict == Verdict::fail)
      red += "\n  " + report(found);
  ADD_FAILURE() << fault.caught_by
                << (known ? " does not catch it: " + report(result) : " is no case")
                << "\nred are:" << red;
}

INSTANTIATE_TEST_SUITE_P(Broken, TheSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

class HealthyClient : public testing::TestWithParam<std::string> {};

TEST_P(HealthyClient, PassesTheWholeSuite) {
  std::size_t passed = 0;
  for (const Case& one : cases(GetParam())) {
    const CaseResult result = run(one, {});
    EXPECT_TRUE(result.verdict == Verdict::pass || result.verdict == Verdict::info)
        << report(result);
    passed += result.verdict == Verdict::pass;
  }
  EXPECT_GT(passed, 0u);
  fmt::print("{:<28} {} cases of {} pass\n", "none", passed, GetParam());
}

INSTANTIATE_TEST_SUITE_P(P2p, HealthyClient,
                         testing::Values("xgt_cnet", "modbus_rtu", "modbus_ascii", "ls_bus",
                                         "user_frames", "udata"),
                         [](const auto& test) { return test.param; });

TEST(FaultTable, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const Fault& fault : faults()) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults().size(), 150u);
}

}  // namespace
}  // namespace fieldproof::p2p_broken
