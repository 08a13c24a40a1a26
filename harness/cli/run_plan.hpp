// Everything of a run that is settled before a byte is sent.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "harness/bench/bench.hpp"
#include "harness/bench/waivers.hpp"
#include "harness/cli/commands.hpp"
#include "harness/vectors/loader.hpp"

namespace fieldproof {

struct RunPlan {
  EndpointName endpoint;
  std::vector<const Protocol*> protocols;  // what the endpoint speaks, at least one
  BenchOptions bench;
  std::vector<Waiver> waivers;
  VectorSet vectors;
  std::vector<const Case*> selected;       // into `vectors`
  Identity identity;                       // of the bench file's device
  std::string line;                        // as the bench file declares it
  std::string journal;                     // of a real device that may be written; empty: none
  std::map<std::string, std::string> hashes;  // with --qualify: SHA-256 of tool, vectors, profile
};

/// Errors are the user's: they name the option, file, line or key.
Result<RunPlan> make_run_plan(const RunOptions& options);

}  // namespace fieldproof
