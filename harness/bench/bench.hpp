// Runs one case after another against one endpoint: eligibility, starting state, exchange,
// judgement, recovery. (Also in bench_others.cpp.)
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/bench_options.hpp"
#include "harness/bench/eligibility.hpp"
#include "harness/bench/fingerprint.hpp"
#include "harness/bench/recovery.hpp"
#include "harness/bench/saving.hpp"
#include "harness/bench/standing.hpp"
#include "harness/exchange/exchange.hpp"
#include "harness/judge/judge.hpp"

namespace fieldproof::bench {

class Bench {
 public:
  /// `known` is shared by benches of one device that is set up in several ways; nullptr: this is
  /// the only one.
  Bench(endpoints::Endpoint& endpoint, const harness::Protocol& protocol, BenchOptions options,
        std::shared_ptr<Standing> known = nullptr);

  /// The first sanity exchange: does anything answer at all? The error tells the engineer what to
  /// check.
  Status start();

  /// Nothing answered in start(), on a line: who is asked there.
  std::optional<exchange::Channel> silent_line() const;

  /// How fast this device answers; none on simulated time, which has no floor, and where start()
  /// found no answer.
  Result<std::optional<AdapterFloor>> measure_floor();
  /// "; silence inside a reply from 1.0 ms (rx_trig_bytes 1 for this run, else 8)", or empty.
  std::string driver_silence() const;
  void use_floor(AdapterFloor floor) { known_->floor = std::move(floor); }
  /// A limit below it is INCONCLUSIVE.
  Duration floor() const { return rules().timing_floor; }

  /// No case can run, for this reason; they are BLOCKED.
  void set_aside(std::string why) { recovery_.stop(std::move(why)); }
  /// The areas of the device, after a sanity exchange; errors of either.
  Result<Fingerprint> fingerprint();

  /// Never throws; whatever goes wrong is in the result. The case outlives the bench.
  results::CaseResult run(const vectors::Case& source);
  /// On simulated time: the same without what it says of the device, for `conclude` of another
  /// bench of the same device. Nothing: it has to be run there.
  std::optional<results::CaseResult> run_ahead(const vectors::Case& source);
  /// Takes in what a case says of the device, in the order of the cases.
  void conclude(results::CaseResult& result);

  /// Would it be sent, for all that can be known before?
  bool could_run(const vectors::Case& source) const;
  /// What its requests write, where it is not moved; nothing where it cannot be prepared.
  std::vector<harness::Protocol::Written> written_by(const vectors::Case& source) const;

  /// After the last case: tries again to put back what could not be. Empty, or what a real device
  /// does not hold as before.
  std::string put_back();
  /// Requests that may have changed memory which nobody can tell (UncheckedWrites::doubtful).
  std::string doubtful_writes() const { return saving_.doubtful_writes(); }
  /// The last: a device that was set up by --control becomes what this bench declares. Empty, or
  /// what is wrong.
  std::string leave_as_declared();

  /// Set-up writes that the device did not take.
  const SetUpFindings& set_up_findings() const { return known_->set_up_findings; }

  /// Why no further case can run: the port failed, or the link is dead. Empty while all is well.
  const std::string& stopped() const { return known_->stopped; }
  bool port_failed() const { return known_->port_failed; }
  bool interrupted() const { return known_->interrupted; }

 private:
  bool declines(const vectors::Case& source, results::CaseResult& result);
  void try_out(results::CaseResult& result);
  const ReadyCase& ready_for(const vectors::Case& source);
  Result<std::string> unmet_premise(const exchange::PreparedCase& prepared);
  bool meets_premises(const exchange::PreparedCase& prepared, results::CaseResult& result);
  Status holds(const exchange::PreparedCase& prepared, const harness::Protocol::Setting& given,
               const std::string& why_not_set);
  nlohmann::json begin_config(const vectors::Case& source) const;
  judging::JudgeRules rules() const;
  exchange::ExchangeTiming timing() const;
  Result<exchange::Sign> answers_when_set_up(const exchange::PreparedCase& prepared, bool started);

  Result<bool> wait_for_request();
  Status end_asking(const exchange::PreparedCase& prepared, bool waits);
  bool begin_case(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool only_writes_are_unanswered(const exchange::PreparedCase& prepared);
  void execute(const exchange::PreparedCase& prepared, results::CaseResult& result);
  void exchange(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool set_up_device(const exchange::PreparedCase& prepared, results::CaseResult& result);
  Status be_fresh(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool prepare_device(const exchange::PreparedCase& prepared, results::CaseResult& result);
  void judge_exchange(const exchange::PreparedCase& prepared,
                      const exchange::Transcript& transcript, results::CaseResult& result);

  Status claim();
  Result<bool> is_disturbed(const results::CaseResult& result);
  void look_for_others(const exchange::PreparedCase& prepared, results::CaseResult& result);

  endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  BenchOptions options_;
  exchange::Arming arming_;
  exchange::MemoryAccess memory_;
  exchange::Exchange exchange_;
  std::shared_ptr<Standing> known_;
  Eligibility eligibility_;
  Recovery recovery_;
  Saving saving_;
  const vectors::Case* last_ = nullptr;  // on an emulator repeats find it again, ready
  ReadyCase last_ready_;
  std::string not_up_;           // why the device cannot be asked as it is to be set up here
  bool just_started_ = false;    // for the present case
  bool set_up_answered_ = true;  // in the present case: saving, setting and restoring memory
  bool silent_ = false;          // nothing came in start()
};

}  // namespace fieldproof::bench
