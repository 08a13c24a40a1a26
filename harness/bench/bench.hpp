// Runs one case after another against one endpoint: eligibility, starting state, exchange,
// judgement, recovery. (Also in bench_eligibility.cpp, bench_others.cpp and bench_recovery.cpp.)
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/adapter_floor.hpp"
#include "harness/bench/fingerprint.hpp"
#include "harness/bench/profile.hpp"
#include "harness/bench/set_up_findings.hpp"
#include "harness/bench/worth_asking.hpp"
#include "harness/endpoints/controlled.hpp"
#include "harness/exchange/exchange.hpp"
#include "harness/judge/judge.hpp"
#include "harness/judge/readings.hpp"
#include "harness/safety/fence.hpp"
#include "harness/safety/saved_memory.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::bench {

/// Behind a pty or a socket writes can arrive milliseconds apart, and the emulator's
/// inter-character time has a floor of 20 ms: shorter times than this prove nothing there.
inline constexpr Duration shortest_judged = 100ms;

struct BenchOptions {
  Profile profile;
  safety::WriteFence fence;
  int station = 1;  // the device's, where the endpoint cannot become another station
  std::string power_cycle_command;    // --power-cycle: what switches a real device off and on
  int max_restarts = 20;              // --max-restarts: of a device that the bench starts itself
  std::string replay;                 // command line that the id of the case completes
  exchange::Channel aux;              // --aux: a second channel of the PLC under test
  harness::Protocols known{{}};       // of further services that a case speaks to
  exchange::ClientProgram stimulus;   // --stimulus: what makes the device ask; empty: none
  bool endpoint_is_stimulus = false;  // --stimulus -: the endpoint's own program is told
  std::vector<const vectors::Case*>
      client_cases;  // all that are selected, where every one of them is of a device that asks
  endpoints::ControlProgram control;         // --control: what sets the device up; empty: none
  bool endpoint_is_control = false;          // --control -: the endpoint's own program is told
  safety::JournalDevice device;              // for the journal of a real device
  safety::JournalDevice aux_device;          // of `aux`
  std::shared_ptr<safety::Journal> journal;  // without one nothing is written to a real device
};

/// What is known of a device, however it is set up.
struct Standing {
  explicit Standing(int max_restarts) : worth_asking(max_restarts) {}

  judging::Readings readings;
  SetUpFindings set_up_findings;
  WorthAsking worth_asking;
  std::optional<AdapterFloor> floor;  // nothing: what is declared
  std::string stopped;                // why no further case can run
  nlohmann::json config;              // that the device was given last
  int errors_in_a_row = 0;
  unsigned starts = 0;  // of the endpoint, when the device was last seen to answer
  bool port_failed = false;
  bool answers = false;  // the device answers probes
  bool interrupted = false;
  bool client_gave_up = false;  // the program under test, in some case
  bool claimed = false;         // a shared line: nobody else was heard before the first case
  int disturbed = 0;            // cases in which somebody else was heard, without a pause
  Time doubt_until{};           // what fails until then may be the work of who was heard last
};

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
  void set_aside(std::string why) { stop(std::move(why)); }
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
  struct Eligibility {
    results::Verdict verdict = results::Verdict::pass;
    std::string reason;
  };
  /// A case as it is sent, or why it is not.
  struct Ready {
    Eligibility why;
    std::vector<results::Move> moves;
    std::unique_ptr<vectors::Case> elsewhere;  // where the declared device has its memory, after
                                               // the moves; nullptr: as it is printed
    std::optional<exchange::PreparedCase> prepared;  // of one of the two; nothing: see `why`
  };
  bool declines(const vectors::Case& source, results::CaseResult& result);
  void try_out(results::CaseResult& result);
  Ready make_ready(const vectors::Case& source) const;
  const Ready& ready_for(const vectors::Case& source);
  Eligibility outside_profile(const vectors::Case& source) const;
  Eligibility blocked(const vectors::Case& source, const exchange::PreparedCase& prepared) const;
  Eligibility below_floor(const exchange::PreparedCase& prepared) const;
  std::string not_carried(const exchange::PreparedCase& prepared) const;
  std::string undeclared(const nlohmann::json& config) const;
  std::string not_of_the_case(const vectors::Case& source) const;
  Result<std::vector<harness::Protocol::Written>> written_over_aux(
      const exchange::PreparedCase& prepared) const;
  std::vector<harness::Protocol::Setting> settings_of(const exchange::PreparedCase& prepared) const;
  std::string fence_objection(const exchange::PreparedCase& prepared) const;
  std::vector<std::string> moved_axes(const exchange::PreparedCase& prepared) const;
  std::string axis_moved_by(const harness::Protocol::Setting& setting) const;
  std::string motion_objection(const exchange::PreparedCase& prepared) const;
  Result<std::string> unmet_premise(const exchange::PreparedCase& prepared);
  bool meets_premises(const exchange::PreparedCase& prepared, results::CaseResult& result);
  std::string out_of_reach(const exchange::PreparedCase& prepared) const;
  std::string unreadable(const std::string& address, std::size_t digits) const;

  Result<exchange::PreparedCase> prepare(const vectors::Case& source) const;
  int station_for(const vectors::Case& source) const;
  nlohmann::json device_config(const vectors::Case& source) const;
  nlohmann::json begin_config(const vectors::Case& source) const;
  bool places_memory_itself(const vectors::Case& source) const;
  judging::JudgeRules rules() const;
  exchange::ExchangeTiming timing() const;
  Result<exchange::Sign> answers_when_set_up(const exchange::PreparedCase& prepared, bool started);

  Result<bool> wait_for_request();
  Status end_asking(const exchange::PreparedCase& prepared, bool waits);
  bool gave_up(const exchange::PreparedCase& prepared, const Error& trouble,
               results::CaseResult& result);
  bool begin_case(const exchange::PreparedCase& prepared, results::CaseResult& result);
  void execute(const exchange::PreparedCase& prepared, results::CaseResult& result);
  std::vector<harness::Protocol::Written> written_by(const exchange::PreparedCase& prepared) const;
  safety::SavedMemory& saved_for(const exchange::PreparedCase& prepared) {
    return prepared.is_client() ? saved_over_aux_ : saved_;
  }
  bool save_partner(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool save_memory(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool writes_without_check(const exchange::PreparedCase& prepared) const;
  void exchange(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool set_up_device(const exchange::PreparedCase& prepared, results::CaseResult& result);
  bool prepare_device(const exchange::PreparedCase& prepared, results::CaseResult& result);
  void judge_exchange(const exchange::PreparedCase& prepared,
                      const exchange::Transcript& transcript, results::CaseResult& result);
  bool look_for_device(results::CaseResult& result, const std::string& what);
  void start_again(results::CaseResult& result);
  void revive(results::CaseResult& result);
  bool power_cycle(results::CaseResult& result, bool client = false);
  void after(const exchange::PreparedCase& prepared, const exchange::Transcript& transcript,
             results::CaseResult& result);
  void stop(std::string why, const Error* error = nullptr);

  Status claim();
  Result<bool> is_disturbed(const results::CaseResult& result);
  void look_for_others(const exchange::PreparedCase& prepared, results::CaseResult& result);

  endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  BenchOptions options_;
  exchange::Arming arming_;
  exchange::MemoryAccess memory_;
  exchange::Exchange exchange_;
  safety::SavedMemory saved_, saved_over_aux_;
  std::shared_ptr<Standing> known_;
  const vectors::Case* last_ = nullptr;  // on an emulator repeats find it again, ready
  Ready last_ready_;
  std::string not_up_;           // why the device cannot be asked as it is to be set up here
  bool just_started_ = false;    // for the present case
  bool set_up_answered_ = true;  // in the present case: saving and setting memory
  bool silent_ = false;          // nothing came in start()
};

}  // namespace fieldproof::bench
