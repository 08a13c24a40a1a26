// Judges recorded exchanges by today's vectors, without the device.
#pragma once

#include <map>
#include <string>

#include "harness/bench/files/profile.hpp"
#include "harness/judge/readings.hpp"
#include "harness/protocols.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

class Rejudge {
 public:
  /// Refers to `vectors`. The profile gives limits and how far decisions bind, as in a run.
  Rejudge(const vectors::VectorSet& vectors, Profile profile, const harness::Protocols& protocols);

  struct Outcome {
    results::CaseResult result;
    std::string why_not;  // why the exchange was not judged again; empty: it was
  };
  /// What was recorded without an exchange (SKIP, BLOCKED, trouble) keeps its verdict. An exchange
  /// that cannot be judged by today's vector is INCONCLUSIVE.
  Outcome judge(const results::CaseResult& recorded);

 private:
  std::map<std::string, const vectors::Case*> cases_;
  Profile profile_;
  harness::Protocols protocols_;
  judging::Readings readings_;
};

}  // namespace fieldproof::bench
