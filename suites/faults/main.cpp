// fieldproof_faults: every fault of our broken devices against every case of their protocol, in
// process. Writes vectors/faults.json, which `fieldproof list --redundant` reads.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "harness/vectors/fault_matrix.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/broken/run_in_process.hpp"
#include "suites/faults/kits.hpp"
#include "suites/protocols.hpp"

namespace {

using namespace fieldproof;

vectors::BrokenDevice run_all(const faults::Kit& kit, const std::vector<vectors::Case>& cases) {
  vectors::BrokenDevice device{kit.name, {}, {}};
  for (const faults::KnownFault& fault : kit.faults) device.faults.push_back(fault.name);
  for (const vectors::Case& one : cases) {
    if (!kit.concerns(one)) continue;
    if (kit.run(std::nullopt, one).verdict != results::Verdict::pass) continue;
    std::set<std::size_t>& by = device.killed[one.id];
    for (std::size_t i = 0; i < kit.faults.size(); ++i)
      if (broken::turns_red(one, kit.run(i, one).verdict)) by.insert(i);
  }
  return device;
}

std::vector<vectors::Case> cases_in(const std::string& folder, const faults::Kit& kit) {
  return vectors::load_vectors(folder, {suites::protocols(), kit.folder + "/*"}).cases;
}

/// `explore` against each fault of these devices, or of all: a line a device, and what it missed.
int explore_all(const std::string& folder, const std::vector<std::string>& devices) {
  constexpr std::uint64_t requests = 20'000;
  for (const faults::Kit& kit : faults::kits()) {
    if (!devices.empty() && std::ranges::find(devices, kit.name, {}) == devices.end()) continue;
    const std::vector<bool> found =
        faults::found_by_exploring(kit, cases_in(folder, kit), requests);
    const auto count = std::ranges::count(found, true);
    if (count == 0) continue;  // nothing answers there
    fmt::print("{}: {} of {} faults within {} requests\n", kit.name, count, found.size(), requests);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (!found[i]) fmt::print("  not {}\n", kit.faults[i].name);
    std::fflush(stdout);
  }
  return 0;
}

std::string shown(const results::CaseResult& result) {
  std::string fields;
  for (const results::Difference& one : result.differences) fields += "; " + one.field;
  return fmt::format("{} {}{}", results::to_string(result.verdict), result.message, fields);
}

/// What a case says of each fault of the devices that it is about.
int show_case(const std::string& folder, const std::string& id) {
  for (const faults::Kit& kit : faults::kits())
    for (const vectors::Case& one : cases_in(folder, kit)) {
      if (one.id != id || !kit.concerns(one)) continue;
      fmt::print("{}: none: {}\n", kit.name, shown(kit.run(std::nullopt, one)));
      for (std::size_t i = 0; i < kit.faults.size(); ++i)
        fmt::print("{}: {}: {}\n", kit.name, kit.faults[i].name, shown(kit.run(i, one)));
    }
  return 0;
}

constexpr const char* usage =
    "usage: fieldproof_faults FOLDER-OF-VECTORS [DEVICE...]\n"
    "Writes faults.json there, anew or for these devices (\"modbus-rtu client\") alone.\n"
    "       fieldproof_faults --explore FOLDER-OF-VECTORS [DEVICE...]\n"
    "Prints which faults `explore` finds.\n"
    "       fieldproof_faults --case FOLDER-OF-VECTORS ID\n"
    "Prints what a case says of each fault.\n";

/// The first name that no device has, or nothing.
std::optional<std::string> unknown_device(const std::vector<std::string>& names) {
  const std::vector<faults::Kit> kits = faults::kits();
  for (const std::string& name : names)
    if (std::ranges::find(kits, name, &faults::Kit::name) == kits.end()) return name;
  return std::nullopt;
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  const bool asks = !given.empty() && (given.front() == "--help" || given.front() == "-h");
  if (asks) return fmt::print("{}", usage), 0;
  const bool explores = given.size() > 1 && given.front() == "--explore";
  if (!given.empty() && given.front() == "--case" && given.size() == 3)
    return show_case(given[1], given[2]);
  if (given.empty() || (given.front().starts_with('-') && !explores))
    return fmt::print(stderr, "{}", usage), 2;
  const std::vector<std::string> devices(given.begin() + (explores ? 2 : 1), given.end());
  if (const std::optional<std::string> unknown = unknown_device(devices))
    return fmt::print(stderr, "there is no device '{}' with faults\n", *unknown), 2;
  if (explores) return explore_all(given[1], devices);
  const std::string& folder = given.front();
  const Result<vectors::FaultMatrix> known = vectors::load_fault_matrix(folder);
  if (!known && given.size() > 1) return fmt::print(stderr, "{}\n", known.error().message), 2;
  vectors::FaultMatrix matrix;
  for (const faults::Kit& kit : faults::kits()) {
    const bool wanted = given.size() == 1 || std::ranges::find(given, kit.name, {}) != given.end();
    if (wanted)
      matrix.push_back(run_all(kit, cases_in(folder, kit)));
    else if (const auto old = std::ranges::find(*known, kit.name, &vectors::BrokenDevice::name);
             old != known->end())
      matrix.push_back(*old);
    else
      continue;
    fmt::print("{}: {} faults, {} cases\n", kit.name, kit.faults.size(),
               matrix.back().killed.size());
    std::fflush(stdout);
  }
  std::ofstream file(folder + "/faults.json");
  file << vectors::to_text(matrix);
  return file.good() ? 0 : 3;
}
