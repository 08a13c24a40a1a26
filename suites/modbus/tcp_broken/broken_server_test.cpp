// The suite against broken Modbus TCP servers: each fault must turn its case red, with a message
// that names it, and the healthy server must pass. All in process, in simulated time.
#include "suites/modbus/tcp_broken/broken_server.hpp"

#include "suites/broken/in_process.hpp"

namespace fieldproof::modbus_tcp_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

/// That of an XGB PLC, or of a XINJE one.
const char* model_of(const Case& one) {
  const bool xinje = one.models == std::vector<std::string>{"xd"};
  return xinje ? "xd" : "xbc-h";
}

/// Of a server of these models alone: no client, no other service of the PLC.
bool concerns(const Case& one) {
  return !vectors::is_client_case(one) && !one.config.contains("services") && one.level != "info" &&
         std::ranges::find(one.models, model_of(one)) != one.models.end();
}

const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of("modbus_tcp/*", concerns);
  return all;
}

auto against(const Behaviour& behaviour) {
  return [behaviour](const Case& source) {
    return broken::against(model_of(source), make_broken_server, behaviour)(source);
  };
}

class ModbusTcpSuite : public testing::TestWithParam<Fault> {};

/// A fault may count: each case meets a new one.
TEST_P(ModbusTcpSuite, Catches) {
  broken::expect_caught(GetParam(), cases(),
                        [](const Case& source) { return against(GetParam().make())(source); });
}

INSTANTIATE_TEST_SUITE_P(Broken, ModbusTcpSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(ModbusTcpHealthyServer, PassesTheWholeSuite) {
  broken::expect_healthy(cases(), 200, against({}));
}

TEST(ModbusTcpFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 90); }

}  // namespace
}  // namespace fieldproof::modbus_tcp_broken
