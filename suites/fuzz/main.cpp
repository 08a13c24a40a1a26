// fieldproof_fuzz [TARGET...] [--inputs N] [--seed S] [--from I]: feeds each target with inputs
// that are nearly right. Ends with 0, or as a crash does; what was fed last is said then, with the
// command that feeds it again.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include "suites/fuzz/mutator.hpp"
#include "suites/fuzz/targets.hpp"

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#endif

namespace {

using namespace fieldproof;

/// What is fed now, for the last words.
std::string now_fed;

void last_words() { std::fprintf(stderr, "fed last: fieldproof_fuzz %s\n", now_fed.c_str()); }

void on_abort(int) {
  last_words();
  std::_Exit(1);
}

struct Options {
  std::vector<std::string> targets;
  std::uint64_t inputs = 100'000, seed = 1, from = 0;
};

void feed(const fuzz::Target& target, const Options& options) {
  const fuzz::Mutator mutator(target.seeds(), options.seed);
  for (std::uint64_t i = options.from; i < options.from + options.inputs; ++i) {
    now_fed = fmt::format("{} --seed {} --from {} --inputs 1", target.name, options.seed, i);
    target.feed(mutator.input(i));
  }
  fmt::print("{:<11} {} inputs: nothing crashed, no rule was broken\n", target.name,
             options.inputs);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Feeds what reads bytes of others with inputs that are nearly right.",
               "fieldproof_fuzz");
  Options options;
  std::string known;
  for (const fuzz::Target& one : fuzz::targets())
    known += fmt::format("\n  {:<11} {}", one.name, one.what);
  app.add_option("targets", options.targets, "All, where none is given:" + known)
      ->check([](const std::string& name) {
        return fuzz::find_target(name) ? "" : "there is no target '" + name + "'";
      });
  app.add_option("--inputs", options.inputs, "For each target");
  app.add_option("--seed", options.seed, "Another one gives other inputs");
  app.add_option("--from", options.from, "The number of the first input");
  CLI11_PARSE(app, argc, argv);
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_set_death_callback(last_words);
#endif
  std::signal(SIGABRT, on_abort);
  std::signal(SIGSEGV, on_abort);
  for (const fuzz::Target& one : fuzz::targets())
    if (options.targets.empty() || std::ranges::count(options.targets, one.name) > 0)
      feed(one, options);
}
