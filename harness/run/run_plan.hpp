// Everything of a run that is settled before a byte is sent.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/bench.hpp"
#include "harness/bench/waivers.hpp"
#include "harness/protocols.hpp"
#include "harness/run/run_options.hpp"
#include "harness/vectors/loader.hpp"
#include "src/line/settings.hpp"

namespace fieldproof {

/// One device and how it is reached.
struct DutPlan {
  EndpointName endpoint;
  Protocols known{{}};                     // that there are
  std::vector<const Protocol*> protocols;  // what the endpoint speaks, at least one
  BenchOptions bench;
  std::string stimulus;  // as --stimulus takes it
  std::optional<EndpointName> aux;
  Identity identity;    // of the bench file's device
  std::string line;     // as the bench file declares it
  std::string journal;  // of a real device that may be written; empty: none
};

struct RunPlan : DutPlan {
  std::vector<DutPlan>
      others;  // further devices, of the same profile and protocols: all share the cases
  std::vector<Waiver> waivers;
  VectorSet vectors;
  std::vector<const Case*> selected;  // into `vectors`
  std::vector<LineSettings> matrix;   // --matrix: steps of the line; empty: there is none
  std::optional<AdapterFloor> floor;  // --floor
  std::optional<EndpointName> loop;  // --loop: where an emulator answers over the same kind of link
  Duration soak{};                   // --duration; 0: no soak
  std::map<std::string, std::string> hashes;  // with --qualify: SHA-256 of tool, vectors, profile

  /// By the number of its port: this one, then `others`.
  const DutPlan& dut(std::size_t port) const { return port == 0 ? *this : others[port - 1]; }
};

/// Errors are the user's: they name the option, file, line or key.
Result<RunPlan> make_run_plan(const RunOptions& options, const Protocols& known);

}  // namespace fieldproof
