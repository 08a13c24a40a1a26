// The suite against broken XGT FEnet servers: each fault must turn its case red, with a message
// that names it, and the healthy server must pass. All in process, in simulated time.
#include "suites/xgt_fenet/broken/broken_server.hpp"

#include "suites/broken/in_process.hpp"

namespace fieldproof::xgt_fenet_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

constexpr const char* model = "xbc-h";

/// Of a server of this model alone: no client, no other service of the PLC.
bool concerns(const Case& one) {
  return !vectors::is_client_case(one) && !one.config.contains("services") &&
         (one.models.empty() || std::ranges::find(one.models, model) != one.models.end());
}

const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of("xgt_fenet/*", concerns);
  return all;
}

auto against(const Behaviour& behaviour) {
  return broken::against(model, make_broken_server, behaviour);
}

class FenetSuite : public testing::TestWithParam<Fault> {};

/// A fault may count: each case meets a new one.
TEST_P(FenetSuite, Catches) {
  broken::expect_caught(GetParam(), cases(),
                        [](const Case& source) { return against(GetParam().make())(source); });
}

INSTANTIATE_TEST_SUITE_P(Broken, FenetSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(FenetHealthyServer, PassesTheWholeSuite) { broken::expect_healthy(cases(), 200, against({})); }

TEST(FenetFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 90); }

}  // namespace
}  // namespace fieldproof::xgt_fenet_broken
