// Cases of lines, counters, the frame monitor, further services and modems against broken PLCs:
// each fault must turn its case red, and the healthy PLC must pass them all. In process alone: who
// sees counters and the monitor looks behind the wire.
#include "suites/broken/in_process.hpp"
#include "suites/services/broken/faults.hpp"

namespace fieldproof::services_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

/// What is only measured tells nothing apart.
const broken::Cases& cases() {
  static const broken::Cases all =
      broken::cases_of("*/*", [](const Case& one) { return concerns(one) && one.level != "info"; });
  return all;
}

auto against(const Behaviour& behaviour) {
  return [behaviour](const Case& source) {
    const harness::Protocol& protocol = *suites::protocols().find(source.protocol);
    const auto make = [&](std::string_view model, const nlohmann::json& config) {
      return make_broken_plc(behaviour, protocol, model, config);
    };
    const Case one = set_up(behaviour, source);
    return broken::run_in_process(one, "", make, broken::bare_profile(one));
  };
}

class ServicesSuite : public testing::TestWithParam<Fault> {};

/// A fault may remember: each case meets a new one.
TEST_P(ServicesSuite, Catches) {
  broken::expect_caught(GetParam(), cases(),
                        [](const Case& source) { return against(GetParam().make())(source); });
}

INSTANTIATE_TEST_SUITE_P(Broken, ServicesSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyPlc, PassesTheWholeSuite) { broken::expect_healthy(cases(), 200, against({})); }

TEST(ServicesFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 50); }

}  // namespace
}  // namespace fieldproof::services_broken
