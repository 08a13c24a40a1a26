// After a case: is the device still there, can it be brought back, is it worth asking further?
#pragma once

#include <string>

#include "harness/bench/bench_options.hpp"
#include "harness/bench/standing.hpp"
#include "harness/exchange/arming.hpp"
#include "harness/exchange/exchange.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

class Recovery {
 public:
  /// All of these outlive it.
  Recovery(endpoints::Endpoint& endpoint, const BenchOptions& options, exchange::Arming& arming,
           exchange::Exchange& exchange, Standing& known)
      : endpoint_(endpoint),
        options_(options),
        arming_(arming),
        exchange_(exchange),
        known_(known) {}

  /// Behind the exchange of a case, whose verdict may become worse.
  void after(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
             results::CaseResult& result);
  /// It did not answer when its memory was read or set for a case: does it still answer anything?
  /// If not, the case says so after `what`.
  bool look_for_device(results::CaseResult& result, const std::string& what);
  /// A device that the bench has started itself, and whose process has ended.
  void start_again(results::CaseResult& result);
  /// False: it does not come back. `client`: a device that asks answers no probe.
  bool power_cycle(results::CaseResult& result, bool client = false);
  /// No further case can run. `error`: because the port has failed.
  void stop(std::string why, const Error* error = nullptr);

 private:
  bool gave_up(const exchange::PreparedCase& prepared, const Error& trouble,
               results::CaseResult& result);
  /// `odd`: it was lost behind what a device may not answer, or its program has ended.
  void revive(results::CaseResult& result, bool odd = false);

  endpoints::Endpoint& endpoint_;
  const BenchOptions& options_;
  exchange::Arming& arming_;
  exchange::Exchange& exchange_;
  Standing& known_;
};

}  // namespace fieldproof::bench
