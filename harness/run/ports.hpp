// What a run talks to: one port for each device, and what stands beside it: a second channel, a
// stimulus.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/bench/benches.hpp"
#include "harness/run/run_plan.hpp"
#include "harness/system/line_program.hpp"

namespace fieldproof::run {

/// What a device has besides its endpoint. Outlives its benches.
class Fixtures {
 public:
  static Result<Fixtures> open(const DutPlan& plan);
  void give(bench::BenchOptions& bench, const DutPlan& plan) const;

 private:
  Status open_aux(const endpoints::EndpointName& name, const safety::JournalDevice& device,
                  const harness::Protocols& known);

  std::unique_ptr<endpoints::Endpoint> aux_;
  std::unique_ptr<harness::Protocol>
      aux_configured_;  // as the profile declares it; nullptr: nothing to declare
  const harness::Protocol* aux_protocol_ = nullptr;
  int aux_station_ = 1;
  std::unique_ptr<os::LineProgram> stimulus_, control_;
};

/// Opens the journal of each device that may be written. The error says what an earlier run left,
/// and what to type.
Status open_journals(const RunOptions& options, RunPlan& plan);

/// By the number of a device in the plan.
struct Devices {
  std::vector<Fixtures> fixtures;  // outlive the ports
  std::vector<bench::Benches> ports;
};

/// Opens each device of the plan and what stands beside it. Of several, one that cannot be opened
/// leaves the plan and is told in its `missing`; the error is that of a device alone, or of all.
Result<Devices> open_devices(RunPlan& plan);

/// More of the simulated device of the plan, one for each processor; none where its cases are run
/// one after another: a soak, a matrix, something beside the device, few cases.
Result<std::vector<bench::Benches>> open_more(const RunPlan& plan, std::size_t cases);

/// Another device on the desk than the bench file has? Also looked at for a sheet to sign
/// (`wanted`), which then shows it.
Status take_fingerprints(RunPlan& plan, std::vector<bench::Benches>& ports, bool wanted);

}  // namespace fieldproof::run
