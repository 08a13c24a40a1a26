// One bench a protocol. A real endpoint speaks one; emulators become whatever protocol a case is
// of.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/bench.hpp"

namespace fieldproof::bench {

class Benches {
 public:
  /// Opens one endpoint for each of `protocols` (at least one). Errors are those of
  /// `open_endpoint`.
  static Result<Benches> open(const endpoints::EndpointName& name,
                              const std::vector<const harness::Protocol*>& protocols,
                              const BenchOptions& options);

  /// The sanity exchange of each; of those that have not stopped.
  Status start();
  /// The same of each as its last case has left it: none is started anew for it.
  Status still_answers();

  /// Bench::silent_line of the first that has one.
  std::optional<exchange::Channel> silent_line() const;

  /// Measures what the link of each can show, before its first case; what it comes to, empty on
  /// simulated time.
  Result<std::string> measure_floor();
  /// The same of the first alone, without using it.
  Result<std::optional<AdapterFloor>> measured_floor() {
    return members_.front().bench().measure_floor();
  }
  /// Instead of measuring: given by hand, or measured over a loop.
  std::string use_floor(const AdapterFloor& floor);

  /// The sanity exchange of each; who does not answer is set aside. Nothing: at least one answers.
  /// An error: the port.
  Status start_those_that_answer();

  /// On the bench of the case's protocol; a case of another protocol is SKIP. A device that can be
  /// set up is set up as the case needs it.
  results::CaseResult run(const vectors::Case& source);
  /// Bench::run_ahead, and what another one of this device makes of it.
  std::optional<results::CaseResult> run_ahead(const vectors::Case& source);
  results::CaseResult conclude(const vectors::Case& source,
                               std::optional<results::CaseResult> ahead);
  /// In the order that starts the device the least often (fewest_starts).
  std::vector<const vectors::Case*> grouped(const std::vector<const vectors::Case*>& cases) const;

  /// How many of these cases could run if the options were others; nothing is sent.
  std::size_t could_run(const std::vector<const vectors::Case*>& cases,
                        const BenchOptions& options) const;
  /// Could this device run it, for all that can be known before?
  std::vector<bool> could_each_run(const std::vector<const vectors::Case*>& cases) const;
  /// What a case of one of the protocols writes, and the protocol that says it.
  std::pair<const harness::Protocol*, std::vector<harness::Protocol::Written>> written_by(
      const vectors::Case& source) const;

  /// Does time cost nothing, and is each case a device of its own?
  bool simulated() const { return members_.front().endpoint->capabilities().simulated; }
  /// Do the links carry speed and character format?
  bool wire() const { return members_.front().endpoint->capabilities().wire; }
  /// Closes the ports; nothing but opening anew may follow.
  void close() { members_.clear(); }

  /// By the first protocol.
  Result<Fingerprint> fingerprint() { return members_.front().bench().fingerprint(); }
  /// SetUpFindings::results of all.
  std::vector<results::CaseResult> set_up_findings() const;
  /// `Bench::put_back` of all.
  std::string put_back();
  /// `Bench::doubtful_writes` of all.
  std::string doubtful_writes() const;

  bool interrupted() const;
  /// The port itself is gone.
  bool port_failed() const { return members_.front().bench().port_failed(); }
  /// Why no further case can run on any of them; empty while one can.
  std::string stopped() const;
  /// "emulator xbc-h".
  std::string describe() const { return members_.front().endpoint->describe(); }
  /// "xgt-cnet, modbus-rtu".
  std::string protocol_names() const;

 private:
  /// A device set up in one way.
  struct SetUp {
    std::unique_ptr<harness::Protocol> configured;  // of a real device: as it has it then
    std::unique_ptr<Bench> bench;
  };
  struct Member {
    const harness::Protocol* protocol;
    std::unique_ptr<endpoints::Endpoint> endpoint;
    BenchOptions options;  // of the device as it is declared
    std::shared_ptr<Standing> known;
    std::map<std::string, SetUp> set_ups{};  // by needed_set_up; "{}": as it is declared
    Bench* last = nullptr;                   // of the last case

    Bench& bench() const { return *set_ups.at("{}").bench; }
  };
  std::size_t index_for(const vectors::Case& source) const;
  const Member& member_for(const vectors::Case& source) const {
    return members_[index_for(source)];
  }

  /// nullptr: with those of the device.
  std::vector<bool> which_could_run(const std::vector<const vectors::Case*>& cases,
                                    const BenchOptions* options) const;
  static Result<SetUp> make_set_up(const Member& member, const nlohmann::json& needed,
                                   const BenchOptions& options);
  static nlohmann::json needed_by(const vectors::Case& source, const Member& member);
  static std::string started_with(const vectors::Case& source, const Member& member,
                                  const nlohmann::json& needed);
  Bench& bench_for(const vectors::Case& source);

  std::vector<Member> members_;
};

}  // namespace fieldproof::bench
