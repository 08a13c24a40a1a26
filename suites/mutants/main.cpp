// fieldproof_mutants: single faults that were made of our own devices by rule, each against all
// cases that come by it, in process and on simulated time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "harness/explore/derived.hpp"
#include "harness/vectors/filter.hpp"
#include "harness/vectors/loader.hpp"
#include "suites/mutants/report.hpp"
#include "suites/protocols.hpp"

namespace {

using namespace fieldproof;
using namespace fieldproof::mutants;

struct Options {
  std::string library, table, vectors, equivalent, out = ".", only = "*";
  bool derived = false;
  std::uint64_t explore = 0;
  unsigned jobs = 2;
  double seconds = 1;
};

void show_progress(std::size_t done, std::size_t of) {
  if (done % 500 == 0 || done == of) fmt::print(stderr, "  {} of {}\n", done, of);
}

/// The hunt through all stages; the report is written after each.
class Run {
 public:
  /// `numbers`: of all mutants, wanted or not.
  Run(const Options& options, MutatedDevices devices, std::string copy, std::size_t numbers,
      std::vector<Mutant> mutants)
      : options_(options),
        devices_(devices),
        copy_(std::move(copy)),
        numbers_(numbers),
        mutants_(std::move(mutants)),
        outcomes_(mutants_.size()) {}

  /// `patience`: how much longer than a case one of these trials may take.
  Status stage(const std::string& name, std::vector<Trial> trials, double patience) {
    const HuntOptions how{&devices_,
                          from_library(copy_),
                          numbers_,
                          {options_.jobs, patience * options_.seconds, std::size_t{4} << 30},
                          show_progress};
    stages_.push_back(name);
    const Status done = hunt({name, std::move(trials)}, mutants_, how, outcomes_);
    if (!done) return done;
    std::ofstream(options_.out + "/mutants.md") << markdown(mutants_, outcomes_, stages_);
    std::ofstream(options_.out + "/outcomes.json") << json_text(mutants_, outcomes_);
    fmt::print("{}", summary(mutants_, outcomes_, stages_));
    std::fflush(stdout);
    return ok();
  }

 private:
  const Options& options_;
  MutatedDevices devices_;
  std::string copy_;  // of the library
  std::size_t numbers_;
  std::vector<Mutant> mutants_;
  std::vector<Outcome> outcomes_;
  std::vector<std::string> stages_;
};

Status run_all(const Options& options) {
  Result<std::vector<Mutant>> mutants = load_table(options.table);
  if (!mutants) return mutants.error();
  if (!options.equivalent.empty())
    if (Status loaded = load_equivalent(options.equivalent, *mutants); !loaded) return loaded;
  const std::size_t numbers = mutants->size();
  std::erase_if(*mutants, [&](const Mutant& one) {
    return !vectors::matches_filter(one.file, options.only);
  });
  if (mutants->empty()) return fail("--file " + options.only + " names no file with mutants");
  const vectors::VectorSet set = vectors::load_vectors(options.vectors, {suites::protocols()});
  if (!set.problems.empty()) return fail(set.problems.front());

  // A file of another name is loaded beside the first.
  const std::string copy = options.out + "/mutated_devices_again.so";
  std::filesystem::copy_file(options.library, copy,
                             std::filesystem::copy_options::overwrite_existing);
  std::vector<unsigned char> reached(numbers + 1);
  become(0, reached.data());
  const Result<MutatedDevices> devices = from_library(options.library)();
  if (!devices) return devices.error();
  Run run(options, *devices, copy, numbers, std::move(*mutants));
  Status done = run.stage("vectors", trials_of(set.cases), 1);
  if (done && options.derived) {
    const Result<std::vector<vectors::Case>> derived = explore::derived_cases(
        set.cases, suites::protocols(), 0, 0, [](const std::string&) { return true; });
    if (!derived) return derived.error();
    done = run.stage("derived", trials_of(*derived), 2);
  }
  if (done && options.explore)
    done = run.stage("explore", explorations(set.cases, options.explore),
                     10 + static_cast<double>(options.explore) / 1000);
  return done;
}

}  // namespace

int main(int count, char** arguments) {
  Options options;
  CLI::App app{"Mutants of our own devices against the vectors"};
  app.add_option("library", options.library, "devices of mutated sources")->required();
  app.add_option("table", options.table, "mutants.json of generate.py")->required();
  app.add_option("vectors", options.vectors, "the folder")->required();
  app.add_option("--equivalent", options.equivalent, "those that were found to be no fault");
  app.add_option("--out", options.out, "folder for mutants.md and outcomes.json");
  app.add_option("--file", options.only, "only mutants of these: 'src/modbus/*'");
  app.add_flag("--derived", options.derived, "what lives, against derived cases, too");
  app.add_option("--explore", options.explore, "and against so many requests of explore");
  app.add_option("--jobs", options.jobs, "processes");
  app.add_option("--seconds", options.seconds, "of processor time that a case may take");
  CLI11_PARSE(app, count, arguments);
  const Status done = run_all(options);
  if (done) return 0;
  fmt::print(stderr, "fieldproof_mutants: {}\n", done.error().message);
  return 3;
}
