// The suite against broken inverters: each fault must turn its case red, with a message that names
// it, and the healthy inverter must pass. As a user would, with the built tool; what takes a back
// door, in process.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "suites/broken/in_process.hpp"
#include "suites/broken/suite_runs.hpp"
#include "suites/ls_bus/broken/broken_inverter.hpp"
#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

using testing::HasSubstr;

constexpr const char* healthy = "none";
const std::string sources = FIELDPROOF_SOURCE_DIR;

std::string case_id(const Fault& fault) { return fmt::format("ls_bus/{}", fault.caught_by); }

/// One file a topic, which loads faster than all.
std::string vectors_of(const Fault& fault) {
  return fmt::format("{}/vectors/ls_bus/{}.json", sources,
                     fault.caught_by.substr(0, fault.caught_by.find('/')));
}

std::string device(std::string_view fault, unsigned station) {
  return fmt::format("{} {} {{tty}} {}?station={}&protocol=ls-bus",
                     tool_tests::quoted(BROKEN_LS_BUS), fault, station, station);
}

std::optional<broken::Trial> trial_of(const std::string& test) {
  if (test == "PassesTheWholeSuite")
    return broken::Trial{healthy, device(healthy, 1), "inverter", {}, "ls_bus/*"};
  const Fault* fault =
      test.starts_with("CatchesOnThePort/") ? find_fault(broken::parameter_of(test)) : nullptr;
  if (!fault) return std::nullopt;
  const std::string id = case_id(*fault);
  return broken::Trial{std::string(fault->name), device(fault->name, fault->station), "inverter",
                       vectors_of(*fault),
                       fault->neighbours == broken::alone ? id : broken::neighbours_of(id)};
}

broken::SuiteRuns& runs() {
  static auto* const environment = static_cast<broken::SuiteRuns*>(
      testing::AddGlobalTestEnvironment(new broken::SuiteRuns(trial_of)));
  return *environment;
}
[[maybe_unused]] const broken::SuiteRuns& registered_before_main = runs();

class LsBusSuite : public testing::TestWithParam<Fault> {};

TEST_P(LsBusSuite, CatchesOnThePort) {
  const Fault& fault = GetParam();
  const broken::SuiteRun run = runs().take(std::string(fault.name));
  broken::expect_caught(run, case_id(fault), fault.message);
  runs().report(fmt::format("{:<32} {:<50} {:>4.1f} s", fault.name, fault.caught_by, run.seconds));
}

/// The case that must catch `fault`, against the inverter of the name `device`.
results::CaseResult run_in_process(const Fault& fault, std::string_view device) {
  const vectors::VectorSet set = vectors::load_vectors(vectors_of(fault));
  const auto source = std::ranges::find(set.cases, case_id(fault), &vectors::Case::id);
  if (source == set.cases.end()) {
    ADD_FAILURE() << "there is no case " << case_id(fault);
    return {};
  }
  const auto make = [device](std::string_view, const nlohmann::json& config) {
    return make_broken_inverter(device, config);
  };
  return broken::run_in_process(*source, "inverter", make,
                                *bench::load_profile("inverter", sources + "/suites/profiles"));
}

class BehindTheBackDoor : public testing::TestWithParam<Fault> {};

TEST_P(BehindTheBackDoor, IsCaughtInProcess) {
  const results::CaseResult result = run_in_process(GetParam(), GetParam().name);
  EXPECT_EQ(result.verdict, results::Verdict::fail) << result.message;
  EXPECT_TRUE(broken::names(result, GetParam().message))
      << "the message does not name '" << GetParam().message << "': " << result.message;
}

TEST_P(BehindTheBackDoor, IsNotSeenInTheHealthyInverter) {
  const results::CaseResult result = run_in_process(GetParam(), healthy);
  EXPECT_EQ(result.verdict, results::Verdict::pass) << result.message;
}

constexpr auto name_of = [](const auto& test) { return std::string(test.param.name); };
INSTANTIATE_TEST_SUITE_P(Broken, LsBusSuite, testing::ValuesIn(broken::on_a_port(faults())),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Broken, BehindTheBackDoor, testing::ValuesIn(back_door_faults()), name_of);

TEST(HealthyInverter, PassesTheWholeSuite) {
  const broken::SuiteRun run = runs().take(healthy);
  const std::size_t passed = broken::expect_healthy(run, 200);
  runs().report(fmt::format("{:<32} {} of {} cases pass, {:.1f} s", healthy, passed,
                            run.results.size(), run.seconds));
}

TEST(InverterFaults, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const auto* table : {&faults(), &back_door_faults()})
    for (const Fault& fault : *table) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(names.size(), 100u);
}

TEST(BrokenInverter, ListsItsFaults) {
  const tool_tests::Finished list = tool_tests::run_program({BROKEN_LS_BUS, "--list"});
  EXPECT_EQ(list.code, 0) << list.err;
  for (const Fault& fault : faults()) EXPECT_THAT(list.out, HasSubstr(fault.name));
}

TEST(BrokenInverter, AnUnknownFaultIsAnErrorThatNamesTheNearest) {
  const tool_tests::TestFolder folder;
  const tool_tests::Finished ended =
      tool_tests::run_program({BROKEN_LS_BUS, "sum_off_by_on", folder / "tty"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("sum_off_by_one"));
}

}  // namespace
}  // namespace fieldproof::ls_bus_broken
