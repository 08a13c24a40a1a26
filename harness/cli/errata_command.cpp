#include "harness/cli/commands.hpp"
#include "harness/run/run_report.hpp"
#include "harness/run/tool_vectors.hpp"
#include "reports/errata.hpp"

namespace fieldproof::cli {

int errata_command(const ErrataOptions& options, const harness::Protocols& protocols) {
  const Result<vectors::VectorSet> set = run::load_sound_vectors(options.vectors, protocols);
  if (!set) return run::complain(set.error().message, run::exit_code::usage);
  std::vector<results::ErratumInfo> errata;
  for (const vectors::Erratum& one : set->errata) errata.push_back(run::erratum_info(one));
  reports::sort_errata(errata);
  if (options.json || options.markdown)
    run::print(options.json ? reports::errata_json(errata) : reports::errata_markdown(errata));
  else
    run::tell(reports::errata_text(errata));
  return run::exit_code::ok;
}

}  // namespace fieldproof::cli
