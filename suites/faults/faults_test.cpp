// Every fault of our broken devices is caught by the case that its table names, and
// vectors/faults.json says what the runs say.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "harness/vectors/fault_matrix.hpp"
#include "harness/vectors/test_own_vectors.hpp"
#include "suites/broken/run_in_process.hpp"
#include "suites/faults/kits.hpp"
#include "suites/protocols.hpp"

namespace fieldproof::faults {

void PrintTo(const Kit& kit, std::ostream* out) { *out << kit.name; }

namespace {

const std::string folder = FIELDPROOF_SOURCE_DIR "/vectors";
constexpr const char* again = "write it anew: fieldproof_faults vectors (README, Figures)";

/// The device of that name in the file.
const vectors::BrokenDevice& written(const std::string& name) {
  static const Result<vectors::FaultMatrix> matrix = vectors::load_fault_matrix(folder);
  static const vectors::BrokenDevice none;
  if (!matrix) ADD_FAILURE() << matrix.error().message;
  if (!matrix) return none;
  const auto found = std::ranges::find(*matrix, name, &vectors::BrokenDevice::name);
  return found == matrix->end() ? none : *found;
}

bool says_red(const vectors::BrokenDevice& device, const std::string& fault,
              const std::string& id) {
  const auto at = std::ranges::find(device.faults, fault);
  const auto found = device.killed.find(id);
  return at != device.faults.end() && found != device.killed.end() &&
         found->second.contains(static_cast<std::size_t>(at - device.faults.begin()));
}

class Faults : public testing::TestWithParam<Kit> {
 protected:
  Faults() : set_(vectors::test::own_vectors(suites::protocols(), GetParam().folder + "/*")) {}

  const vectors::Case* find(const std::string& id) const {
    const auto found = std::ranges::find(set_.cases, id, &vectors::Case::id);
    return found == set_.cases.end() ? nullptr : &*found;
  }

  const vectors::VectorSet& set_;
};

/// The case that turns red by this fault: the one of the fault's table, or where that takes a port
/// (memory that was written before, a device that was started anew) the first of the file.
std::string catcher(const Kit& kit, std::size_t fault, const vectors::Case* of_table) {
  if (of_table && broken::turns_red(*of_table, kit.run(fault, *of_table).verdict))
    return of_table->id;
  const auto at = std::ranges::find(written(kit.name).faults, kit.faults[fault].name);
  const auto position = static_cast<std::size_t>(at - written(kit.name).faults.begin());
  for (const auto& [id, by] : written(kit.name).killed)
    if (by.contains(position)) return id;
  return {};
}

TEST_P(Faults, AreAllCaughtByNamedCases) {
  const Kit& kit = GetParam();
  std::size_t caught = 0;
  for (std::size_t i = 0; i < kit.faults.size(); ++i) {
    const std::string& name = kit.faults[i].name;
    const std::string id = catcher(kit, i, find(kit.faults[i].caught_by));
    const vectors::Case* const one = find(id);
    const bool red = one && broken::turns_red(*one, kit.run(i, *one).verdict);
    EXPECT_TRUE(red) << name << " is not caught by " << kit.faults[i].caught_by;
    EXPECT_TRUE(says_red(written(kit.name), name, id))
        << "faults.json does not know that " << id << " catches " << name << "; " << again;
    caught += red;
  }
  EXPECT_GT(kit.faults.size(), 0u);
  fmt::print("{}: {} of {} faults caught by named cases\n", kit.name, caught, kit.faults.size());
}

/// Some of the pairs, drawn by a seed: all of them would take minutes.
TEST_P(Faults, AreAsTheFileSays) {
  const Kit& kit = GetParam();
  const vectors::BrokenDevice& device = written(kit.name);
  std::vector<const vectors::Case*> cases;
  for (const vectors::Case& one : set_.cases)
    if (device.killed.contains(one.id)) cases.push_back(&one);
  ASSERT_FALSE(cases.empty()) << "faults.json knows no case of " << kit.name << "; " << again;
  std::mt19937 random(20140300);  // NOLINT: the same pairs each time
  for (int i = 0; i < 50; ++i) {
    const std::size_t fault = random() % kit.faults.size();
    const vectors::Case& one = *cases[random() % cases.size()];
    const std::string& name = kit.faults[fault].name;
    if (std::ranges::find(device.faults, name) == device.faults.end()) continue;  // said above
    EXPECT_EQ(broken::turns_red(one, kit.run(fault, one).verdict), says_red(device, name, one.id))
        << one.id << " against " << name << ": faults.json says otherwise; " << again;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Faults, testing::ValuesIn(kits()), [](const auto& test) {
  std::string name = test.param.name;
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == ' '; }, '_');
  return name;
});

/// Without a case that was written for them.
TEST(Exploring, FindsMostFaultsOfAServer) {
  const std::vector<Kit> all = kits();
  const auto kit = std::ranges::find(all, "modbus-ascii", &Kit::name);
  ASSERT_NE(kit, all.end());
  const std::vector<vectors::Case>& cases =
      vectors::test::own_vectors(suites::protocols(), kit->folder + "/*").cases;
  const std::vector<bool> found = found_by_exploring(*kit, cases, 1000);
  EXPECT_GE(std::ranges::count(found, true), static_cast<std::ptrdiff_t>(found.size() * 6 / 10));
}

}  // namespace
}  // namespace fieldproof::faults
