// The suite against broken devices: each fault must turn its case red, with a message that names
// it, and the healthy device must pass.
#include <gmock/gmock.h>

#include "suites/broken/suite_runs.hpp"
#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

using testing::HasSubstr;

constexpr const char* healthy = "none";

std::string case_id(const Fault& fault) { return fmt::format("xgt_cnet/{}", fault.caught_by); }

std::string device(std::string_view fault, unsigned station) {
  return fmt::format("{} {} {{tty}} {} '{{folder}}/storage'?station={}",
                     tool_tests::quoted(BROKEN_XGT_CNET), fault, station, station);
}

broken::Trial trial_for(const Fault& fault) {
  // One file a chapter, which loads faster than all.
  const std::string_view chapter = fault.caught_by.substr(0, fault.caught_by.find('/'));
  const std::string id = case_id(fault);
  return {std::string(fault.name), device(fault.name, fault.station), "xbc-h",
          fmt::format("{}/vectors/xgt_cnet/{}.json", FIELDPROOF_SOURCE_DIR, chapter),
          fault.neighbours == broken::alone ? id
          : fault.neighbours.empty()        ? broken::neighbours_of(id)
                                            : std::string(fault.neighbours)};
}

std::optional<broken::Trial> trial_of(const std::string& test) {
  if (test == "PassesTheWholeSuite")
    return broken::Trial{healthy, device(healthy, 1), "xbc-h", {}, "xgt_cnet/*"};
  const Fault* fault = find_fault(broken::parameter_of(test));
  return fault ? std::optional(trial_for(*fault)) : std::nullopt;
}

broken::SuiteRuns& runs() {
  static auto* const environment = static_cast<broken::SuiteRuns*>(
      testing::AddGlobalTestEnvironment(new broken::SuiteRuns(trial_of)));
  return *environment;
}
[[maybe_unused]] const broken::SuiteRuns& registered_before_main = runs();

class CnetSuite : public testing::TestWithParam<Fault> {};

TEST_P(CnetSuite, Catches) {
  const Fault& fault = GetParam();
  const broken::SuiteRun run = runs().take(std::string(fault.name));
  const std::string message = broken::expect_caught(run, case_id(fault), fault.message);
  runs().report(fmt::format("{:<40} {:<54} {:>4.1f} s  {}", fault.name, fault.caught_by,
                            run.seconds, message));
}

INSTANTIATE_TEST_SUITE_P(Broken, CnetSuite, testing::ValuesIn(broken::on_a_port(faults())),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(HealthyDevice, PassesTheWholeSuite) {
  const broken::SuiteRun run = runs().take(healthy);
  const std::size_t passed = broken::expect_healthy(run, 1000);
  runs().report(fmt::format("{:<40} {} of {} cases pass, {:.1f} s", healthy, passed,
                            run.results.size(), run.seconds));
}

TEST(CnetFaultTable, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const Fault& fault : faults()) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults().size(), 100u);
}

TEST(CnetBrokenServer, ListsItsFaults) {
  const tool_tests::Finished list = tool_tests::run_program({BROKEN_XGT_CNET, "--list"});
  EXPECT_EQ(list.code, 0) << list.err;
  for (const Fault& fault : faults()) EXPECT_THAT(list.out, HasSubstr(fault.name));
}

TEST(CnetBrokenServer, AnUnknownFaultIsAnErrorThatNamesTheNearest) {
  const tool_tests::TestFolder folder;
  const tool_tests::Finished ended =
      tool_tests::run_program({BROKEN_XGT_CNET, "bcc_off_by_on", folder / "tty"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("bcc_off_by_one"));
}

}  // namespace
}  // namespace fieldproof::xgt_cnet_broken
