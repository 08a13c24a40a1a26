// Runs one case after another against one endpoint: eligibility, starting state, exchange,
// judgement, recovery.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/adapter_floor.hpp"
#include "harness/bench/fingerprint.hpp"
#include "harness/bench/profile.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/exchange/exchange.hpp"
#include "harness/judge/judge.hpp"
#include "harness/judge/readings.hpp"
#include "harness/safety/fence.hpp"
#include "harness/safety/saved_memory.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof {

struct BenchOptions {
  Profile profile;
  WriteFence fence;
  int station = 1;  // the device's, where the endpoint cannot become another station
  std::string power_cycle_command;    // --power-cycle: what switches a real device off and on
  std::string replay;                 // command line that the id of the case completes
  AuxLink aux;                        // --aux: a second channel of the PLC under test
  TellStimulus stimulus;              // --stimulus: what makes the device ask; empty: none
  bool endpoint_is_stimulus = false;  // --stimulus -: the endpoint's own program is told
  std::vector<const Case*>
      client_cases;      // all that are selected, where every one of them is of a device that asks
  JournalDevice device;  // for the journal of a real device
  JournalDevice aux_device;          // of `aux`
  std::shared_ptr<Journal> journal;  // without one nothing is written to a real device
};

class Bench {
 public:
  Bench(Endpoint& endpoint, const Protocol& protocol, BenchOptions options);

  /// The first sanity exchange: does anything answer at all? The error tells the engineer what to
  /// check.
  Status start();

  /// How fast this device answers; none on simulated time, which has no floor, and where start()
  /// found no answer.
  Result<std::optional<AdapterFloor>> measure_floor();
  void use_floor(AdapterFloor floor) { floor_ = std::move(floor); }
  /// A limit below it is INCONCLUSIVE.
  Duration floor() const { return rules().timing_floor; }

  /// No case can run, for this reason; they are BLOCKED.
  void set_aside(std::string why) { stop(std::move(why)); }
  /// The areas of the device, after a sanity exchange; errors of either.
  Result<Fingerprint> fingerprint();

  /// Never throws; whatever goes wrong is in the result.
  CaseResult run(const Case& source);

  /// After the last case: tries again to put back what could not be. Empty, or what a real device
  /// does not hold as before.
  std::string put_back();

  /// Why no further case can run: the port failed, or the link is dead. Empty while all is well.
  const std::string& stopped() const { return stopped_; }
  bool port_failed() const { return port_failed_; }
  bool interrupted() const { return interrupted_; }

 private:
  struct Eligibility {
    Verdict verdict = Verdict::pass;
    std::string reason;
  };
  Eligibility outside_profile(const Case& source) const;
  Eligibility blocked(const Case& source, const PreparedCase& prepared) const;
  CaseResult run_as_it_is(const Case& source, const std::vector<Move>& moves);
  Eligibility below_floor(const PreparedCase& prepared) const;
  std::string undeclared(const nlohmann::json& config) const;
  Result<std::vector<Protocol::Written>> written_over_aux(const PreparedCase& prepared) const;
  std::string fence_objection(const PreparedCase& prepared) const;

  int station_for(const Case& source) const;
  nlohmann::json device_config(const Case& source) const;
  JudgeRules rules() const;
  ExchangeTiming timing() const;

  Result<bool> wait_for_request();
  Status end_asking(const PreparedCase& prepared);
  bool begin_case(const PreparedCase& prepared, CaseResult& result);
  void execute(const PreparedCase& prepared, CaseResult& result);
  std::vector<Protocol::Written> written_by(const PreparedCase& prepared) const;
  SavedMemory& saved_for(const PreparedCase& prepared) {
    return prepared.is_client() ? saved_over_aux_ : saved_;
  }
  bool save_memory(const PreparedCase& prepared, CaseResult& result);
  void exchange(const PreparedCase& prepared, CaseResult& result);
  bool prepare_device(const PreparedCase& prepared, CaseResult& result);
  void judge_exchange(const PreparedCase& prepared, const Transcript& transcript,
                      CaseResult& result);
  void look_for_device(CaseResult& result);
  void revive(CaseResult& result);
  bool power_cycle(CaseResult& result);
  void after(const PreparedCase& prepared, const Transcript& transcript, CaseResult& result);
  void stop(std::string why, const Error* error = nullptr);

  Endpoint& endpoint_;
  const Protocol& protocol_;
  BenchOptions options_;
  Arming arming_;
  MemoryAccess memory_;
  Exchange exchange_;
  std::optional<AdapterFloor> floor_;  // nothing: what is declared
  Readings readings_;
  SavedMemory saved_, saved_over_aux_;
  std::string stopped_;
  int errors_in_a_row_ = 0;
  bool port_failed_ = false;
  bool answers_ = false;  // the device answers probes
  bool interrupted_ = false;
};

}  // namespace fieldproof
