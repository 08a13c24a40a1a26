// fieldproof_fuzz [TARGET...] [--inputs N] [--seed S] [--from I]: feeds each target with inputs
// that are nearly right. --protocol NAME: of the targets whose first byte chooses one, this one
// alone. Ends with 0, or as a crash does; what was fed last is said then, with the
// command that feeds it again. fieldproof_fuzz --write-seeds FOLDER: the good inputs, for
// libFuzzer.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "suites/fuzz/chosen.hpp"
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
  std::string seeds;  // a folder
  std::string protocol;
};

/// With --protocol: no others.
std::vector<Bytes> seeds_of(const fuzz::Target& target, const std::string& protocol) {
  std::vector<Bytes> seeds = target.seeds();
  if (!protocol.empty())
    std::erase_if(seeds, [&](const Bytes& one) {
      return one.empty() || fuzz::protocol_of(one.front()).name() != protocol;
    });
  return seeds;
}

/// The good inputs as files: FOLDER/TARGET/0001.
void write_seeds(const fuzz::Target& target, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder / target.name);
  std::size_t number = 0;
  for (const Bytes& one : target.seeds()) {
    const auto path = folder / target.name / fmt::format("{:04}", ++number);
    std::ofstream(path, std::ios::binary) << to_text(one);
  }
  fmt::print("{:<11} {}\n", target.name, number);
}

void feed(const fuzz::Target& target, const Options& options) {
  const fuzz::Mutator mutator(seeds_of(target, options.protocol), options.seed);
  const std::string more = options.protocol.empty() ? "" : " --protocol " + options.protocol;
  for (std::uint64_t i = options.from; i < options.from + options.inputs; ++i) {
    now_fed =
        fmt::format("{} --seed {} --from {} --inputs 1{}", target.name, options.seed, i, more);
    Bytes input = mutator.input(i);
    if (!more.empty() && !input.empty()) input.front() = *fuzz::number_of(options.protocol);
    target.feed(input);
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
  std::vector<fuzz::Target> targets(fuzz::targets().begin(), fuzz::targets().end());
  std::string known;
  for (const fuzz::Target& one : targets) known += fmt::format("\n  {:<11} {}", one.name, one.what);
  app.add_option("targets", options.targets, "All, where none is given:" + known)
      ->check([](const std::string& name) {
        return fuzz::find_target(name) ? "" : "there is no target '" + name + "'";
      });
  app.add_option("--inputs", options.inputs, "For each target");
  app.add_option("--seed", options.seed, "Another one gives other inputs");
  app.add_option("--from", options.from, "The number of the first input");
  app.add_option("--write-seeds", options.seeds, "Feed nothing, write the good inputs to a folder");
  app.add_option("--protocol", options.protocol, "Frames, devices and memory of this one alone")
      ->check([](const std::string& name) {
        return fuzz::number_of(name) ? "" : "there is no protocol '" + name + "'";
      });
  CLI11_PARSE(app, argc, argv);
  std::erase_if(targets, [&](const fuzz::Target& one) {
    const bool wanted =
        options.targets.empty() || std::ranges::count(options.targets, one.name) > 0;
    return !wanted || (!options.protocol.empty() && !one.chooses);
  });
#if defined(__SANITIZE_ADDRESS__)
  __sanitizer_set_death_callback(last_words);
#endif
  std::signal(SIGABRT, on_abort);
  std::signal(SIGSEGV, on_abort);
  for (const fuzz::Target& one : targets)
    options.seeds.empty() ? feed(one, options) : write_seeds(one, options.seeds);
}
