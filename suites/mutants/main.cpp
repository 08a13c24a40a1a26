// fieldproof_mutants: single faults that were made of our own devices by rule, each against all
// cases that come by it, in process and on simulated time.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
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

int complain(const std::string& message) {
  fmt::print(stderr, "fieldproof_mutants: {}\n", message);
  return 3;
}

void show_progress(std::size_t done, std::size_t of) {
  if (done % 500 == 0 || done == of) fmt::print(stderr, "  {} of {}\n", done, of);
}

int run(const Options& options) {
  Result<std::vector<Mutant>> mutants = load_table(options.table);
  if (!mutants) return complain(mutants.error().message);
  if (!options.equivalent.empty())
    if (const Status loaded = load_equivalent(options.equivalent, *mutants); !loaded)
      return complain(loaded.error().message);
  const vectors::VectorSet set = vectors::load_vectors(options.vectors, {suites::protocols()});
  if (!set.problems.empty()) return complain(set.problems.front());

  const std::size_t all = mutants->size();
  std::vector<Outcome> outcomes(all);
  for (std::size_t i = 0; i < all; ++i)
    if (!vectors::matches_filter((*mutants)[i].file, options.only)) outcomes[i].fate = Fate::red;

  HuntOptions how{from_library(options.library),
                  {options.jobs, options.seconds, std::size_t{4} << 30},
                  show_progress};
  std::vector<std::string> stages;
  const auto stage = [&](const std::string& name, std::vector<Trial> trials, double patience) {
    how.effort.seconds = patience * options.seconds;
    stages.push_back(name);
    return hunt({name, std::move(trials)}, *mutants, how, outcomes);
  };
  if (const Status done = stage("vectors", trials_of(set.cases), 1); !done)
    return complain(done.error().message);
  std::vector<vectors::Case> derived;
  if (options.derived) {
    Result<std::vector<vectors::Case>> made = explore::derived_cases(
        set.cases, suites::protocols(), 0, 0, [](const std::string&) { return true; });
    if (!made) return complain(made.error().message);
    derived = std::move(*made);
    if (const Status done = stage("derived", trials_of(derived), 2); !done)
      return complain(done.error().message);
  }
  if (options.explore) {
    const auto requests = static_cast<double>(options.explore);
    if (const Status done =
            stage("explore", explorations(set.cases, options.explore), 10 + requests / 1000);
        !done)
      return complain(done.error().message);
  }
  std::erase_if(outcomes,
                [](const Outcome& one) { return one.fate == Fate::red && one.stage.empty(); });
  std::erase_if(*mutants, [&](const Mutant& one) {
    return !vectors::matches_filter(one.file, options.only);
  });
  std::ofstream(options.out + "/mutants.md") << markdown(*mutants, outcomes, stages);
  std::ofstream(options.out + "/outcomes.json") << json_text(*mutants, outcomes);
  fmt::print("{}", summary(*mutants, outcomes, stages));
  return 0;
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
  return run(options);
}
