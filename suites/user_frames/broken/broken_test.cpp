// The suite against broken ports: each fault must turn its case red, and the healthy port must pass
// them all. Everything runs in process: user-defined frames have no request that reads memory, so
// that no other endpoint sees what is stored.
#include "suites/broken/in_process.hpp"
#include "suites/user_frames/broken/faults.hpp"
#include "suites/user_frames/protocol.hpp"

namespace fieldproof::user_frames_broken {

using vectors::Case;

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

/// Without the cases of P2P blocks: suites/p2p/broken.
const broken::Cases& cases() {
  static const broken::Cases all = broken::cases_of(
      "user_frames/*", [](const Case& one) { return !one.config.contains("p2p"); });
  return all;
}

auto against(const Behaviour& behaviour) {
  return [behaviour](const Case& source) {
    const auto make = [&](std::string_view model, const nlohmann::json& config) {
      return make_broken_port(behaviour, model, config);
    };
    return broken::run_in_process(source, "", make, broken::bare_profile(source));
  };
}

class UserFramesSuite : public testing::TestWithParam<Fault> {};

TEST_P(UserFramesSuite, Catches) {
  broken::expect_caught(GetParam(), cases(), against(GetParam().make));
}

INSTANTIATE_TEST_SUITE_P(Broken, UserFramesSuite, testing::ValuesIn(faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyPort, PassesTheWholeSuite) { broken::expect_healthy(cases(), 200, against({})); }

/// Servers on a network; their clients are in suites/p2p/broken.
const broken::Cases& server_cases() {
  static const broken::Cases all = broken::cases_of(
      "user_frames_net/*", [](const Case& one) { return !vectors::is_client_case(one); });
  return all;
}

auto server(const Behaviour& behaviour) {
  return [behaviour](const Case& source) {
    const auto make = [&](std::string_view model, const nlohmann::json& config) {
      return make_broken_server(behaviour, model, config);
    };
    return broken::run_in_process(source, "", make, broken::bare_profile(source));
  };
}

class OnANetwork : public testing::TestWithParam<Fault> {};

TEST_P(OnANetwork, IsCaught) {
  broken::expect_caught(GetParam(), server_cases(), server(GetParam().make));
}

INSTANTIATE_TEST_SUITE_P(Broken, OnANetwork, testing::ValuesIn(server_faults()),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(UserFramesHealthyServer, PassesTheWholeSuite) {
  broken::expect_healthy(server_cases(), 30, server({}));
}

TEST(UserFrameFacts, HoldInTheTables) {
  const vectors::VectorSet set =
      vectors::load_vectors(FIELDPROOF_SOURCE_DIR "/vectors/user_frames");
  ASSERT_FALSE(set.tables.empty());
  for (const Case& one : set.tables) {
    const Status fact = user_frames_suite::protocol().check_fact(one.facts);
    EXPECT_TRUE(fact) << one.id << ": " << fact.error().message;
  }
}

TEST(UserFramesFaultTable, NamesAreUnique) {
  broken::expect_unique_names(faults(), 40);
  broken::expect_unique_names(server_faults(), 30);
}

}  // namespace
}  // namespace fieldproof::user_frames_broken
