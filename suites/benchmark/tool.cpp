// The whole tool, from its start to its exit, reports included.
#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "suites/benchmark/benchmarks.hpp"

namespace fieldproof::suites {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void become(std::vector<std::string>& words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const int nothing = ::open("/dev/null", O_WRONLY);
  dup2(nothing, STDOUT_FILENO);
  execv(argv[0], argv.data());
  _exit(127);
}

/// Runs the tool, and returns the most memory that it held at once, in MiB.
double run_tool(const std::string& tool, const std::vector<std::string>& arguments) {
  const fs::path out = fs::temp_directory_path() / fmt::format("fieldproof_bench_{}", getpid());
  std::vector<std::string> words{tool, "run", "--out", out.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  const pid_t child = fork();
  if (child == 0) become(words);
  int status = 0;
  rusage usage{};
  if (child < 0 || wait4(child, &status, 0, &usage) < 0)
    throw std::runtime_error("cannot start " + tool);
  fs::remove_all(out);
  if (status != 0)
    throw std::runtime_error(fmt::format("{} failed: {}", tool, fmt::join(words, " ")));
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

void tool_run(benchmark::State& state, const std::string& tool,
              const std::vector<std::string>& arguments) {
  double peak = 0;
  for (auto _ : state) {
    (void)_;
    peak = std::max(peak, run_tool(tool, arguments));
  }
  state.counters["peak_MiB"] = peak;
}

constexpr const char* repeated = "xgt_cnet/rss/two_words/lower";

}  // namespace

/// Each kind of run by each tool in turn, so that they see the same machine.
void register_tool_runs(const Tools& tools, bool brief) {
  const std::string many = brief ? "100" : "100000";
  const std::pair<std::string, std::vector<std::string>> runs[] = {
      {"one_case", {"--filter", repeated}},
      {"default", {}},
      {"default_three_times", {"--repeat", "3"}},
      {"one_case_" + many + "_times", {"--filter", repeated, "--repeat", many}}};
  for (const auto& [name, arguments] : runs)
    for (const auto& [whose, tool] : tools)
      benchmark::RegisterBenchmark(("tool/" + name + whose).c_str(),
                                   [tool = tool, arguments = arguments](benchmark::State& state) {
                                     tool_run(state, tool, arguments);
                                   })
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime()
          ->Iterations(brief                ? 1
                       : name == "one_case" ? 20
                                            : 5);
}

}  // namespace fieldproof::suites
