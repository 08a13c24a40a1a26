// What can be settled before a byte is sent: may a case run, where, and what does it write?
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "harness/bench/bench_options.hpp"
#include "harness/bench/moments.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/exchange/arming.hpp"
#include "harness/exchange/memory_access.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/vectors/case.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

/// `pass`: the case may run; else its verdict, and why.
struct Ruling {
  results::Verdict verdict = results::Verdict::pass;
  std::string reason;

  bool may_run() const { return verdict == results::Verdict::pass; }
};

/// A case as it is sent, or why it is not.
struct ReadyCase {
  Ruling why;
  std::vector<results::Move> moves;
  std::unique_ptr<vectors::Case> elsewhere;  // where the declared device has its memory, after the
                                             // moves; nullptr: as it is printed
  std::optional<exchange::PreparedCase> prepared;  // of one of the two; nothing: see `why`
};

class Eligibility {
 public:
  /// All of these outlive it.
  Eligibility(const endpoints::Endpoint& endpoint, const harness::Protocol& protocol,
              const BenchOptions& options, const exchange::Arming& arming,
              const exchange::MemoryAccess& memory)
      : endpoint_(endpoint),
        protocol_(protocol),
        options_(options),
        arming_(arming),
        memory_(memory) {}

  /// The result points into the case, which outlives it.
  ReadyCase ready(const vectors::Case& source) const;
  /// As it is written, were it moved nowhere: may it run on this device?
  Ruling unmoved(const vectors::Case& source) const;

  /// As it is written. Errors name the step.
  Result<exchange::PreparedCase> prepare(const vectors::Case& source) const;
  /// For an emulator, which becomes what the case is about.
  nlohmann::json device_config(const vectors::Case& source) const;

  /// What the requests of a case write, in its order; over the second channel where it alone is
  /// written.
  std::vector<harness::Protocol::Written> written_by(const exchange::PreparedCase& prepared) const;
  /// What is set over the second channel. An error: it cannot be.
  Result<std::vector<harness::Protocol::Written>> written_over_aux(
      const exchange::PreparedCase& prepared) const;
  std::vector<std::string> moved_axes(const exchange::PreparedCase& prepared) const;
  /// Given memory that nothing sets, but something reads: it may hold what the case begins with.
  /// Empty, or why it cannot be set.
  std::string only_read(const exchange::PreparedCase& prepared,
                        const harness::Protocol::Setting& given) const;

 private:
  Ruling outside_profile(const vectors::Case& source) const;
  Ruling blocked(const vectors::Case& source, const exchange::PreparedCase& prepared) const;
  Moments moments(const exchange::PreparedCase& prepared) const;
  Ruling below_floor(const exchange::PreparedCase& prepared, const Moments& moments) const;
  int station_for(const vectors::Case& source) const;
  bool places_memory_itself(const vectors::Case& source) const;
  std::string not_carried(const exchange::PreparedCase& prepared) const;
  std::string undeclared(const nlohmann::json& config) const;
  std::string not_of_the_case(const vectors::Case& source) const;
  std::vector<harness::Protocol::Setting> settings_of(const exchange::PreparedCase& prepared) const;
  std::string fence_objection(const exchange::PreparedCase& prepared) const;
  std::string axis_moved_by(const harness::Protocol::Setting& setting) const;
  std::string motion_objection(const exchange::PreparedCase& prepared) const;
  std::string out_of_reach(const exchange::PreparedCase& prepared) const;
  std::string unreadable(const std::string& address, std::size_t digits) const;

  const endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  const BenchOptions& options_;
  const exchange::Arming& arming_;
  const exchange::MemoryAccess& memory_;
};

}  // namespace fieldproof::bench
