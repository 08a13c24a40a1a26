// The suite against broken P2P clients: each fault must turn its case red, and the healthy client
// must pass them all. Everything runs in process: what a client saves and shows no request reads,
// so that the bench needs its memory.
#include <map>

#include "suites/broken/in_process.hpp"
#include "suites/p2p/broken/faults.hpp"

namespace fieldproof::p2p_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

std::string folder_of(std::string_view id) { return std::string(id.substr(0, id.find('/'))); }

/// A client, without the frame monitor, which stands outside of it, and without a server beside it;
/// or a port with UDATA instructions, not a modem.
bool concerns(const Case& one) {
  if (one.protocol == "udata")
    return one.config.contains("instructions") && !one.config.value("monitor", false);
  return vectors::is_client_case(one) && !one.config.value("monitor", false) &&
         !one.config.contains("services");
}

/// The cases of a folder that concern the faults here.
const broken::Cases& cases(const std::string& folder) {
  static std::map<std::string, broken::Cases> known;
  const auto [found, is_new] = known.try_emplace(folder);
  if (is_new) found->second = broken::cases_of(folder + "/*", concerns);
  return found->second;
}

/// That of a case; user frames name theirs themselves.
std::string model_of(const Case& one) {
  if (one.protocol.starts_with("user-frames")) return "";
  const bool any = one.models.empty() || std::ranges::find(one.models, "xbc-h") != one.models.end();
  return any ? "xbc-h" : one.models.front();
}

auto against(const Behaviour& behaviour) {
  return [behaviour](const Case& source) {
    const auto make = [&](std::string_view model, const nlohmann::json& config) {
      return make_broken_client(behaviour, source.protocol, model, config);
    };
    return broken::run_in_process(source, model_of(source), make, broken::bare_profile(source));
  };
}

class P2pSuite : public testing::TestWithParam<Fault> {};

/// A fault may count: each case meets a new one.
TEST_P(P2pSuite, Catches) {
  const broken::Cases& all = cases(folder_of(GetParam().caught_by));
  broken::expect_caught(GetParam(), all,
                        [](const Case& source) { return against(GetParam().make())(source); });
}

INSTANTIATE_TEST_SUITE_P(Broken, P2pSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

class HealthyClient : public testing::TestWithParam<std::string> {};

TEST_P(HealthyClient, PassesTheWholeSuite) {
  broken::expect_healthy(cases(GetParam()), 0, against({}));
}

INSTANTIATE_TEST_SUITE_P(P2p, HealthyClient,
                         testing::Values("xgt_cnet", "modbus_rtu", "modbus_ascii", "ls_bus",
                                         "user_frames", "udata", "xgt_fenet", "modbus_tcp",
                                         "user_frames_net"),
                         [](const auto& test) { return test.param; });

TEST(P2pFaultTable, NamesAreUnique) { broken::expect_unique_names(faults(), 150); }

}  // namespace
}  // namespace fieldproof::p2p_broken
