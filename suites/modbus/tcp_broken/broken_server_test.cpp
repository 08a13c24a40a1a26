// The suite against broken Modbus TCP servers: each fault must turn its case red, with a message
// that names it, and the healthy server must pass. All in process, in simulated time.
#include "suites/modbus/tcp_broken/broken_server.hpp"

#include "suites/broken/in_process.hpp"

namespace fieldproof::modbus_tcp_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

constexpr const char* model = "xbc-h";

/// Of a server of this model alone: no client, no other service of the PLC.
bool concerns(const Case& one) {
  return !vectors::is_client_case(one) && !one.config.contains("services") &&
         std::ranges::find(one.models, model) != one.models.end();
}

const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of("modbus_tcp/*", concerns);
  return all;
}

auto against(const Behaviour& behaviour) {
  return broken::against(model, make_broken_server, behaviour);
}

class TheSuite : public testing::TestWithParam<Fault> {};

/// A fault may count: each case meets a new one.
TEST_P(TheSuite, Catches) {
  broken::expect_caught(GetParam(), cases(),
                        [](const Case& source) { return against(GetParam().make())(source); });
}

INSTANTIATE_TEST_SUITE_P(Broken, TheSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyServer, PassesTheWholeSuite) { broken::expect_healthy(cases(), 200, against({})); }

TEST(FaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 90); }

}  // namespace
}  // namespace fieldproof::modbus_tcp_broken
