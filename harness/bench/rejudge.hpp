// Judges recorded exchanges by today's vectors, without the device.
#pragma once

#include <map>
#include <string>

#include "harness/bench/profile.hpp"
#include "harness/judge/readings.hpp"
#include "harness/protocols.hpp"
#include "harness/vectors/loader.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof {

class Rejudge {
 public:
  /// Refers to `vectors`. The profile gives limits and how far decisions bind, as in a run.
  Rejudge(const VectorSet& vectors, Profile profile, const Protocols& protocols);

  struct Outcome {
    CaseResult result;
    std::string why_not;  // why the exchange was not judged again; empty: it was
  };
  /// What was recorded without an exchange (SKIP, BLOCKED, trouble) keeps its verdict. An exchange
  /// that cannot be judged by today's vector is INCONCLUSIVE.
  Outcome judge(const CaseResult& recorded);

 private:
  std::map<std::string, const Case*> cases_;
  Profile profile_;
  Protocols protocols_;
  Readings readings_;
};

}  // namespace fieldproof
