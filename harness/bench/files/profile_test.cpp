#include "harness/bench/files/profile.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <fstream>
#include <map>

namespace fieldproof::bench {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

const fs::path shipped = std::string(FIELDPROOF_SOURCE_DIR) + "/suites/profiles";

/// A folder of profiles that goes with the test.
class Profiles : public testing::Test {
 protected:
  Profiles() { fs::create_directories(folder_); }
  ~Profiles() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / (name + ".json")) << text;
  }
  Profile load(const std::string& name) {
    const Result<Profile> profile = load_profile(name, folder_);
    EXPECT_TRUE(profile) << profile.error().message;
    return profile ? *profile : Profile{};
  }
  std::string error(const std::string& name) {
    const Result<Profile> profile = load_profile(name, folder_);
    return profile ? "accepted" : profile.error().message;
  }
  std::string file(const std::string& name) { return (folder_ / (name + ".json")).string(); }

  fs::path folder_ =
      fs::path(testing::TempDir()) /
      ("profiles_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(Profiles, WhatIsExtendedHoldsKeyByKey) {
  write(
      "base",
      R"({"name": "base", "title": "Base", "model": "xbc-h", "protocols": ["xgt-cnet"], "decisions": "binding", "notes": "n", "peer": true,
                    "config": {"rs485": true, "delay_ms": 10}, "timing": {"response_max_ms": 300, "floor_ms": 2},
                    "exclude": [{"id": "a/*", "reason": "r"}]})");
  write(
      "mine",
      R"({"name": "mine", "extends": "base", "decisions": "advisory", "config": {"delay_ms": 50}, "timing": {"floor_ms": 5},
                    "exclude": [{"id": "b/*", "reason": "s"}]})");
  const Profile mine = load("mine");
  EXPECT_EQ(mine.name, "mine");
  EXPECT_EQ(mine.title, "Base");
  EXPECT_EQ(mine.notes, "n");
  EXPECT_EQ(mine.model, "xbc-h");
  EXPECT_FALSE(mine.decisions.all);
  EXPECT_TRUE(mine.peer);
  EXPECT_EQ(mine.config, (nlohmann::json{{"rs485", true}, {"delay_ms", 50}}));
  EXPECT_EQ(mine.response_max, 300ms);
  EXPECT_EQ(mine.floor, 5ms);
  EXPECT_THAT(mine.exclude, ElementsAre(testing::Pair("a/*", "r"), testing::Pair("b/*", "s")));
}

TEST_F(Profiles, CirclesAndUnknownBasesNameTheFiles) {
  write("a", R"({"name": "a", "extends": "b"})");
  write("b", R"({"name": "b", "extends": "a"})");
  write("self", R"({"name": "self", "extends": "self"})");
  write("lost", R"({"name": "lost", "extends": "selv"})");
  write("number", R"({"name": "number", "extends": 5})");
  EXPECT_EQ(error("a"), "cannot read profile " + file("a") + ": it extends itself: " + file("a") +
                            " extends " + file("b") + " extends " + file("a") + " (extended by " +
                            file("a") + ")");
  EXPECT_THAT(error("self"), HasSubstr("it extends itself"));
  EXPECT_THAT(error("lost"), HasSubstr("no profile 'selv'; did you mean 'self'?"));
  EXPECT_THAT(error("lost"), HasSubstr("(extended by " + file("lost") + ")"));
  EXPECT_THAT(error("number"),
              HasSubstr(file("number") + ": \"extends\" is the name of another profile"));
}

TEST_F(Profiles, ANameIsNotInherited) {
  write("base", R"({"name": "base", "protocols": ["xgt-cnet"]})");
  write("nameless", R"({"extends": "base"})");
  EXPECT_THAT(error("nameless"), HasSubstr("it has no \"name\""));
}

TEST_F(Profiles, APathExtendsWhatLiesBesideItOrWhatIsShipped) {
  write("base", R"({"name": "base", "model": "mine", "protocols": ["xgt-cnet"]})");
  write("beside", R"({"name": "beside", "extends": "base"})");
  write("far", R"({"name": "far", "extends": "xbl-c41a", "model": "xbm-s"})");
  EXPECT_EQ(load_profile(file("beside"), shipped)->model, "mine");
  const Result<Profile> far = load_profile(file("far"), shipped);
  ASSERT_TRUE(far) << far.error().message;
  EXPECT_EQ(far->model, "xbm-s");
  EXPECT_EQ(far->config.value("rs485", false), true);
}

TEST_F(Profiles, MistakesAreNamed) {
  const auto message = [](const std::string& text) {
    return parse_profile(text, "p.json", {}).error().message;
  };
  EXPECT_THAT(message(R"({"name": "x", "protocols": ["xgt-cnet"], "modle": "xbc-h"})"),
              HasSubstr("unknown key 'modle'; did you mean 'model'?"));
  EXPECT_THAT(message(R"({"name": "x", "protocols": ["a"], "timing": {"response": 1}})"),
              HasSubstr("unknown key timing.response"));
  EXPECT_THAT(
      message(R"({"name": "x", "protocols": ["a"], "timing": {"response_max": "5 parsecs"}})"),
      HasSubstr("timing.response_max: '5 parsecs' is no duration"));
  EXPECT_THAT(message(R"({"name": "x", "protocols": ["a"], "timing": {"response_max": 5}})"),
              HasSubstr("timing.response_max: '5' is no duration"));
  EXPECT_THAT(message(R"({"name": "x"})"), HasSubstr("no \"protocols\""));
  for (const char* decisions : {R"("advisori")", "[]", "[1]", "true"})
    EXPECT_THAT(
        message(fmt::format(R"({{"name": "x", "protocols": ["a"], "decisions": {}}})", decisions)),
        HasSubstr("decisions is \"binding\", \"advisory\", or a list"))
        << decisions;
  EXPECT_THAT(message("{"), HasSubstr("p.json"));
  EXPECT_THAT(load_profile("xbc-j", shipped).error().message, HasSubstr("did you mean 'xbc-h'?"));
}

/// Every model of the manuals has a profile under which nothing binds that the manuals leave open.
TEST(ShippedProfiles, EveryModelOfTheManuals) {
  const std::map<std::string, std::string> models{
      {"xbm-dxxxs", "xbm-s"},       {"xbc-dxxxh", "xbc-h"},       {"xec-dxxxh", "xec-h"},
      {"xbc-dxxxsu", "xbc-dxxxsu"}, {"xec-dxxxsu", "xec-dxxxsu"}, {"xbc-dxxxe", "xbc-dxxxe"},
      {"xec-dxxxe", "xec-dxxxe"},   {"xbl-c21a", "xbl-c21a"},     {"xbl-c41a", "xbl-c41a"}};
  for (const auto& [name, model] : models) {
    const Result<Profile> profile = load_profile(name, shipped);
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_EQ(profile->model, model);
    EXPECT_FALSE(profile->decisions.all) << name;
    EXPECT_EQ(profile->response_max, 500ms) << name;
    EXPECT_EQ(profile->notes.empty(), model != name)
        << name << ": where the areas are not printed, the notes say so";
  }
}

TEST(Profile, NamesTheDecisionsThatBind) {
  const Result<Profile> profile = parse_profile(
      R"({"name": "x", "protocols": ["a"], "decisions": ["xnet/word-order", "xnet/refresh"]})",
      "p.json", {});
  ASSERT_TRUE(profile) << profile.error().message;
  EXPECT_TRUE(profile->decisions.holds("xnet/refresh"));
  EXPECT_FALSE(profile->decisions.holds("xnet/feedback"));
}

TEST(Profile, LimitsHaveUnits) {
  const Result<Profile> profile = parse_profile(
      R"({"name": "x", "protocols": ["a"], "timing": {"response_max": "0.25s", "turnaround_min": "1.5ms", "floor": "500us", "max_gap": "4ms", "guard_band": 0.2}})",
      "p", {});
  ASSERT_TRUE(profile) << profile.error().message;
  EXPECT_EQ(profile->response_max, 250ms);
  EXPECT_EQ(profile->turnaround_min, 1500us);
  EXPECT_EQ(profile->floor, 500us);
  EXPECT_EQ(profile->max_gap, 4ms);
  EXPECT_EQ(profile->guard_band, 0.2);
}

}  // namespace
}  // namespace fieldproof::bench
