// Everything of a run that is settled before a byte is sent.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/bench.hpp"
#include "harness/bench/files/waivers.hpp"
#include "harness/protocols.hpp"
#include "harness/run/run_options.hpp"
#include "harness/vectors/loader.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::run {

/// One device and how it is reached.
struct DutPlan {
  endpoints::EndpointName endpoint;
  harness::Protocols known{{}};                     // that there are
  std::vector<const harness::Protocol*> protocols;  // what the endpoint speaks, at least one
  bench::BenchOptions bench;
  std::string stimulus, control;  // as --stimulus and --control take them
  std::optional<endpoints::EndpointName> aux;
  results::Identity identity;  // of the bench file's device
  std::string line;            // as the bench file declares it
  bool ends_with_run =
      false;                // the bench starts the device itself: it forgets all with its process
  bool writes_all = false;  // as such a device may be
  std::string journal;      // of a real device that may be written; empty: none
};

struct RunPlan : DutPlan {
  std::vector<DutPlan>
      others;  // further devices, of the same profile and protocols: all share the cases
  std::vector<bench::Waiver> waivers;
  vectors::VectorSet vectors;
  std::vector<const vectors::Case*> selected;  // into `vectors`
  std::vector<line::LineSettings> matrix;      // --matrix: steps of the line; empty: there is none
  std::size_t without_line = 0;                // cases of networks, which --matrix leaves out
  std::optional<bench::AdapterFloor> floor;    // --floor
  std::optional<endpoints::EndpointName>
      loop;                      // --loop: where an emulator answers over the same kind of link
  Duration soak{};               // --duration; 0: no soak
  Duration wait_port{};          // --wait-port: for a port that is absent or in use
  std::vector<Error> missing{};  // of several devices: what could not be opened, and why
  std::map<std::string, std::string> hashes;  // with --qualify: SHA-256 of tool, vectors, profile

  /// By the number of its port: this one, then `others`.
  const DutPlan& dut(std::size_t port) const { return port == 0 ? *this : others[port - 1]; }
};

/// Errors are the user's: they name the option, file, line or key.
Result<RunPlan> make_run_plan(const RunOptions& options, const harness::Protocols& known);

}  // namespace fieldproof::run
