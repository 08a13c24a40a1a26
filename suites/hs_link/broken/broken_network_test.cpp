// The suite against broken stations of the high-speed link, in process, in simulated time: each
// fault must turn its case red, and healthy stations must pass.
#include "suites/hs_link/broken/broken_network.hpp"

#include "suites/broken/in_process.hpp"

namespace fieldproof::hs_link_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

constexpr const char* model = "xbc-h";

bool concerns(const Case& one) {
  return one.models.empty() || std::ranges::find(one.models, model) != one.models.end();
}

const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of("hs_link/*", concerns);
  return all;
}

auto against(const Behaviour& behaviour) {
  return broken::against(model, make_broken_network, behaviour);
}

class HsLinkSuite : public testing::TestWithParam<Fault> {};

TEST_P(HsLinkSuite, Catches) {
  broken::expect_caught(GetParam(), cases(), against(GetParam().make()));
}

INSTANTIATE_TEST_SUITE_P(Broken, HsLinkSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyStations, PassTheWholeSuite) { broken::expect_healthy(cases(), 150, against({})); }

TEST(HsLinkFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 30); }

}  // namespace
}  // namespace fieldproof::hs_link_broken
