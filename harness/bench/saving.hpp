// What a case writes on a real device is saved before it, and put back after it.
#pragma once

#include <string>
#include <vector>

#include "harness/bench/bench_options.hpp"
#include "harness/bench/eligibility.hpp"
#include "harness/bench/recovery.hpp"
#include "harness/bench/unchecked_writes.hpp"
#include "harness/safety/saved_memory.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::bench {

/// How long a request for memory waits for its answer: a device may delay each of them.
Duration patience_with(const Profile& profile);

class Saving {
 public:
  /// All of these outlive it.
  Saving(endpoints::Endpoint& endpoint, const harness::Protocol& protocol,
         const BenchOptions& options, const Eligibility& eligibility, Recovery& recovery);

  /// What the case is to write is read surely. False: it must not run, and the result says why.
  bool save(const exchange::PreparedCase& prepared, results::CaseResult& result);
  /// The last `save` had sound answers, as far as it asked.
  bool was_answered() const { return answered_; }

  /// Around the exchange of a case that writes without a check (UncheckedWrites). `cut_off`: the
  /// port failed in it.
  void before_exchange(const exchange::PreparedCase& prepared) {
    unchecked_.before(unchecked_writes(prepared), changes(prepared), protocol_, own_);
  }
  void after_exchange(const results::CaseResult& result, bool cut_off) {
    unchecked_.after(result, protocol_, own_, cut_off);
  }
  /// UncheckedWrites::doubtful.
  std::string doubtful_writes() const { return unchecked_.doubtful(own_.damaged() > 0); }

  /// After a case what is open is put back. A device that falls silent now, or dies, did so in this
  /// case; unless the run has `stopped` before. False: no sound answer came.
  bool put_back(results::CaseResult& result, bool stopped);
  /// What is open is put back. Empty, or what could not be, and why; it is tried again after the
  /// next case.
  std::string restore();
  /// What is not put back: "%MW100 = 00E2, %MW101 = 0000".
  std::string open_places() const;

 private:
  safety::SavedMemory& memory_of(const exchange::PreparedCase& prepared) {
    return prepared.is_client() ? over_aux_ : own_;
  }
  bool save_partner(const exchange::PreparedCase& prepared, results::CaseResult& result);
  std::vector<Bytes> unchecked_writes(const exchange::PreparedCase& prepared) const;
  std::vector<harness::Protocol::Written> changes(const exchange::PreparedCase& prepared) const;

  const endpoints::Endpoint& endpoint_;
  const harness::Protocol& protocol_;
  const BenchOptions& options_;
  const Eligibility& eligibility_;
  Recovery& recovery_;
  safety::SavedMemory own_, over_aux_;
  UncheckedWrites unchecked_;
  bool answered_ = true;
};

}  // namespace fieldproof::bench
