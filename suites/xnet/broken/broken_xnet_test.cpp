// The suite against broken PLCs and axes of X-NET, in process, in simulated time: each fault must
// turn its case red, and the healthy model must pass.
#include "suites/xnet/broken/broken_xnet.hpp"

#include "suites/broken/in_process.hpp"

namespace fieldproof::xnet_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of("xnet/*", [](const Case&) { return true; });
  return all;
}

auto against(const Behaviour& behaviour) {
  return [behaviour](const Case& source) {
    const auto make = [&](std::string_view of, const nlohmann::json& config) {
      return make_broken_xnet(behaviour, of, config);
    };
    const std::string model = source.models.empty() ? "xd3" : source.models.front();
    return broken::run_in_process(source, model, make, broken::bare_profile(source));
  };
}

class XnetSuite : public testing::TestWithParam<Fault> {};

TEST_P(XnetSuite, Catches) {
  broken::expect_caught(GetParam(), cases(), against(GetParam().make()));
}

INSTANTIATE_TEST_SUITE_P(Broken, XnetSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyPlcs, PassTheWholeSuite) { broken::expect_healthy(cases(), 700, against({})); }

TEST(XnetFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 80); }

}  // namespace
}  // namespace fieldproof::xnet_broken
