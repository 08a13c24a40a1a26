// fieldproof_bench: the figures of the README. Times are measured here and never asserted in a
// test. Besides the options of Google Benchmark it takes
//   --against TOOL   another build of the tool, measured in turn with this one ("before")
//   --brief          runs through all of it with hardly a repetition, to see that it can
// The tool is FIELDPROOF_EXECUTABLE, else `fieldproof` beside this program.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "harness/paths.hpp"
#include "suites/benchmark/benchmarks.hpp"

namespace fieldproof::suites {

namespace fs = std::filesystem;

namespace {

/// Takes an option of ours out of the arguments.
bool take(std::vector<char*>& arguments, std::string_view name) {
  return std::erase_if(arguments, [&](const char* one) { return one == name; }) > 0;
}

std::string take_value(std::vector<char*>& arguments, std::string_view name) {
  const auto found = std::ranges::find(arguments, name, [](char* one) { return one; });
  if (found == arguments.end()) return "";
  const auto value = found + 1;
  if (value == arguments.end()) throw std::runtime_error(fmt::format("{} wants a value", name));
  std::string text = *value;
  arguments.erase(found, value + 1);
  return text;
}

/// Also what the pty endpoint of this very process starts.
std::string find_tool() {
  const char* named = std::getenv("FIELDPROOF_EXECUTABLE");
  const std::string path =
      named && *named ? named : (harness::own_executable().parent_path() / "fieldproof").string();
  if (!fs::exists(path))
    throw std::runtime_error("cannot find the tool at " + path +
                             "; build it, or name it by FIELDPROOF_EXECUTABLE");
  setenv("FIELDPROOF_EXECUTABLE", path.c_str(), 1);
  return path;
}

int run_benchmarks(int argc, char** argv) {
  std::vector<char*> arguments(argv, argv + argc);
  const bool brief = take(arguments, "--brief");
  const std::string against = take_value(arguments, "--against");
  Tools tools;
  if (!against.empty()) tools.emplace_back("/before", against);
  tools.emplace_back(against.empty() ? "" : "/after", find_tool());
  std::string shortest = "--benchmark_min_time=0.001";
  if (brief) arguments.push_back(shortest.data());
  int count = static_cast<int>(arguments.size());
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  // First: the peak of a child is never below what this process held when it made it.
  register_tool_runs(tools, brief);
  register_exchanges(brief);
  register_network(tools.back().second, brief);
  register_simulated(brief);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

}  // namespace
}  // namespace fieldproof::suites

int main(int argc, char** argv) {
  try {
    return fieldproof::suites::run_benchmarks(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "fieldproof_bench: {}\n", error.what());
    return 1;
  }
}
