// The suite against broken Modbus TCP servers: each fault must turn its case red, with a message
// that names it, and the healthy server must pass. All in process, in simulated time.
#include "suites/modbus/tcp_broken/broken_server.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>

#include "harness/bench/bench.hpp"
#include "harness/endpoints/emulator.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::modbus_tcp_broken {

using results::CaseResult;
using results::Verdict;
using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

constexpr const char* model = "xbc-h";

/// Of a server of this model alone: no client, no other service of the PLC.
bool concerns(const Case& one) {
  return !vectors::is_client_case(one) && !one.config.contains("services") &&
         std::ranges::find(one.models, model) != one.models.end();
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    const vectors::VectorSet set = vectors::load_vectors(FIELDPROOF_SOURCE_DIR "/vectors",
                                                         {suites::protocols(), "modbus_tcp/*"});
    EXPECT_THAT(set.problems, testing::IsEmpty());
    std::vector<Case> own;
    std::ranges::copy_if(set.cases, std::back_inserter(own), concerns);
    return own;
  }();
  return all;
}

CaseResult run(const Case& source, const Behaviour& behaviour) {
  endpoints::EmulatorEndpoint endpoint(
      {"emulator", model, {}},
      [&](std::string_view of, const nlohmann::json& config) {
        return make_broken_server(behaviour, of, config);
      },
      {}, modbus_suite::tcp().default_port());
  bench::BenchOptions options;
  options.profile.name = "emulator";
  options.profile.protocols = {"modbus-tcp"};
  options.known = suites::protocols();
  bench::Bench bench(endpoint, modbus_suite::tcp(), options);
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
  const auto one = std::ranges::find(cases(), fault.caught_by, &Case::id);
  const bool known = one != cases().end();
  const CaseResult result = known ? run(*one, fault.make()) : CaseResult{};
  if (known && result.verdict == Verdict::fail &&
      report(result).find(fault.message) != std::string::npos)
    return fmt::print("{:<34} {}\n", fault.name, report(result));
  std::string red;
  for (const Case& other : cases())
    if (const CaseResult found = run(other, fault.make()); found.verdict == Verdict::fail)
      red += "\n  " + report(found);
  ADD_FAILURE() << fault.caught_by
                << (known ? " does not catch it: " + report(result) : " is no case")
                << "\nred are:" << red;
}

INSTANTIATE_TEST_SUITE_P(Broken, TheSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyServer, PassesTheWholeSuite) {
  std::size_t passed = 0;
  for (const Case& one : cases()) {
    const CaseResult result = run(one, {});
    EXPECT_TRUE(result.verdict == Verdict::pass || result.verdict == Verdict::info)
        << report(result);
    passed += result.verdict == Verdict::pass;
  }
  EXPECT_GT(passed, 200u);
  fmt::print("none: {} of {} cases pass\n", passed, cases().size());
}

TEST(FaultTable, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const Fault& fault : faults()) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults().size(), 90u);
}

}  // namespace
}  // namespace fieldproof::modbus_tcp_broken
