#include "harness/bench/device_set_up.hpp"

#include <gmock/gmock.h>

#include "harness/exchange/scripted_endpoint.hpp"
#include "harness/test_protocol.hpp"

namespace fieldproof::bench {
namespace {

using nlohmann::json;

struct Configurable : exchange::ScriptedEndpoint {
  explicit Configurable(std::vector<std::string> taken) : keys(std::move(taken)) {}
  bool configures(std::string_view key) const override {
    return std::ranges::find(keys, key) != keys.end();
  }
  std::vector<std::string> keys;
};

json needed(const json& config, const std::vector<std::string>& keys, const Profile& profile = {},
            const std::vector<std::string>& models = {}) {
  vectors::Case source;
  source.config = config;
  source.models = models;
  return needed_set_up(source, profile, 1, Configurable(keys), harness::TestProtocol());
}

TEST(NeededSetUp, IsWhatDiffersAndCanBeGiven) {
  EXPECT_EQ(needed({{"delay_ms", 10}, {"slot", 3}}, {"delay_ms"}), json({{"delay_ms", 10}}));
  EXPECT_EQ(needed({{"delay_ms", "0"}, {"mode", "run"}}, {"delay_ms", "mode"}), json::object());
}

TEST(NeededSetUp, AStationIsANumber) {
  EXPECT_EQ(needed({{"station", "31"}}, {"station"}), json({{"station", 31}}));
  EXPECT_EQ(needed({{"station", "1"}}, {"station"}), json::object());
  EXPECT_EQ(needed({{"station", 31}}, {}), json::object());
}

TEST(NeededSetUp, BothEndsOfALineAreNotGiven) {
  EXPECT_EQ(needed({{"line", "1200-7E1"}, {"bench_line", "9600-8N1"}}, {"line", "bench_line"}),
            json::object());
}

TEST(NeededSetUp, TheProfileLeavesTheModelToTheCase) {
  EXPECT_EQ(needed({}, {"model"}, {}, {"other"}), json({{"model", "other"}}));
  EXPECT_EQ(needed({}, {"model"}, {}, {"other", "test"}), json({{"model", "test"}}))
      << "the usual one, where it will do";
  Profile declared;
  declared.model = "test";
  EXPECT_EQ(needed({}, {"model"}, declared, {"other"}), json::object());
}

TEST(WholeConfig, HasWhatIsDeclaredOverWhatIsUsual) {
  Profile profile;
  profile.config = {{"delay_ms", 50}};
  const json config = whole_config(profile, 7, harness::TestProtocol());
  EXPECT_EQ(config["delay_ms"], 50);
  EXPECT_EQ(config["mode"], "run");
  EXPECT_EQ(config["station"], 7);
  EXPECT_EQ(config["model"], "test");
}

}  // namespace
}  // namespace fieldproof::bench
