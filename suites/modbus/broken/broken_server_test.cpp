// The suite against broken Modbus servers: each fault must turn its case red, with a message that
// names it, and the healthy server must pass in both modes.
#include <gmock/gmock.h>

#include "suites/broken/suite_runs.hpp"
#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

namespace {

using testing::HasSubstr;

constexpr const char* profile = "xbc-h";

/// "modbus_rtu/..." is tried in mode "rtu".
std::string mode_of(std::string_view id) {
  return id.starts_with("modbus_ascii/") ? "ascii" : "rtu";
}

std::string device(std::string_view mode, std::string_view fault, unsigned station) {
  return fmt::format("{} {} {} {{tty}} {}?station={}&protocol=modbus-{}",
                     tool_tests::quoted(BROKEN_MODBUS), mode, fault, station, station, mode);
}

broken::Trial trial_for(const Fault& fault) {
  const std::string id(fault.caught_by);
  return {std::string(fault.name), device(mode_of(id), fault.name, fault.station), profile,
          FIELDPROOF_SOURCE_DIR "/vectors",
          fault.neighbours == broken::alone ? id
          : fault.neighbours.empty()        ? broken::neighbours_of(id)
                                            : std::string(fault.neighbours)};
}

broken::Trial whole_suite(const std::string& mode) {
  return {
      "healthy_" + mode, device(mode, "none", 1), profile, {}, fmt::format("modbus_{}/*", mode)};
}

std::optional<broken::Trial> trial_of(const std::string& test) {
  const std::string parameter = broken::parameter_of(test);
  if (test.starts_with("PassesTheWholeSuite")) return whole_suite(parameter);
  const Fault* fault = find_fault(parameter);
  return fault ? std::optional(trial_for(*fault)) : std::nullopt;
}

broken::SuiteRuns& runs() {
  static auto* const environment = static_cast<broken::SuiteRuns*>(
      testing::AddGlobalTestEnvironment(new broken::SuiteRuns(trial_of)));
  return *environment;
}
[[maybe_unused]] const broken::SuiteRuns& registered_before_main = runs();

class ModbusSuite : public testing::TestWithParam<Fault> {};

TEST_P(ModbusSuite, Catches) {
  const Fault& fault = GetParam();
  const broken::SuiteRun run = runs().take(std::string(fault.name));
  const std::string message =
      broken::expect_caught(run, std::string(fault.caught_by), fault.message);
  runs().report(fmt::format("{:<40} {:<60} {:>4.1f} s  {}", fault.name, fault.caught_by,
                            run.seconds, message));
}

INSTANTIATE_TEST_SUITE_P(Broken, ModbusSuite, testing::ValuesIn(broken::on_a_port(faults())),
                         [](const auto& test) { return std::string(test.param.name); });

class ModbusHealthyServer : public testing::TestWithParam<std::string> {};

TEST_P(ModbusHealthyServer, PassesTheWholeSuite) {
  const broken::SuiteRun run = runs().take("healthy_" + GetParam());
  const std::size_t passed = broken::expect_healthy(run, 100);
  runs().report(fmt::format("healthy_{:<32} {} of {} cases pass, {:.1f} s", GetParam(), passed,
                            run.results.size(), run.seconds));
}

INSTANTIATE_TEST_SUITE_P(Modbus, ModbusHealthyServer, testing::Values("rtu", "ascii"),
                         [](const auto& test) { return test.param; });

TEST(ModbusFaultTable, NamesAreUnique) {
  std::map<std::string_view, int> names;
  for (const Fault& fault : faults()) EXPECT_EQ(++names[fault.name], 1) << fault.name;
  EXPECT_GE(faults().size(), 75u);
}

TEST(ModbusBrokenServer, ListsItsFaults) {
  const tool_tests::Finished list = tool_tests::run_program({BROKEN_MODBUS, "--list"});
  EXPECT_EQ(list.code, 0) << list.err;
  for (const Fault& fault : faults()) EXPECT_THAT(list.out, HasSubstr(fault.name));
}

TEST(ModbusBrokenServer, AnUnknownFaultIsAnErrorThatNamesTheNearest) {
  const tool_tests::TestFolder folder;
  const tool_tests::Finished ended =
      tool_tests::run_program({BROKEN_MODBUS, "rtu", "crc_ignore", folder / "tty"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_THAT(ended.err, HasSubstr("crc_ignored"));
}

/// The words of M that requests would write are known: the fence holds for Modbus as for device
/// names.
TEST(WriteFence, HoldsForTheWordsOfTheDefaultBases) {
  const tool_tests::TestFolder folder;
  const auto run_with = [&](const std::string& allowed) {
    return tool_tests::run_tool({"run", "--endpoint", "exec:" + device("rtu", "none", 1),
                                 "--profile", profile, "--allow-write", allowed, "--filter",
                                 "modbus_rtu/writes/one_word/v1234", "--out", folder / "out"});
  };
  EXPECT_EQ(run_with("M99-M101").code, 0);
  const tool_tests::Finished outside = run_with("M99-M100");
  EXPECT_EQ(outside.code, 4) << outside.out << outside.err;
  EXPECT_THAT(outside.out, HasSubstr("BLOCKED"));
}

}  // namespace
}  // namespace fieldproof::modbus_broken
