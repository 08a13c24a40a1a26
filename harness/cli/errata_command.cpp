#include "harness/cli/commands.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/tool_vectors.hpp"
#include "reports/errata.hpp"

namespace fieldproof {

int errata_command(const ErrataOptions& options) {
  const Result<VectorSet> set = load_sound_vectors(options.vectors);
  if (!set) return complain(set.error().message, exit_code::usage);
  std::vector<ErratumInfo> errata;
  for (const Erratum& one : set->errata) errata.push_back(erratum_info(one));
  sort_errata(errata);
  print(options.json       ? errata_json(errata)
        : options.markdown ? errata_markdown(errata)
                           : errata_text(errata));
  return exit_code::ok;
}

}  // namespace fieldproof
