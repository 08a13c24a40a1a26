// Seeded sequences against a device and our own model of it; each difference is a finding, made as
// short as it still shows.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "harness/explore/sequence.hpp"
#include "harness/protocol.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::explore {

/// The device under test.
struct Device {
  const harness::Protocol* protocol = nullptr;
  std::function<results::CaseResult(const vectors::Case&)> run;
  std::function<bool()> alive = [] { return true; };  // false: no further case can run
};

/// What a sequence showed that the model does not do.
struct Finding {
  vectors::Case shortest;      // that still shows it
  results::CaseResult result;  // of it
  std::uint64_t times = 1;     // sequences that showed the same
  bool confirmed = false;      // three times in a row; else it was seen, and not again
};

class Explorer {
 public:
  Explorer(Device device, std::unique_ptr<Inventor> inventor)
      : device_(std::move(device)), inventor_(std::move(inventor)) {}

  bool can_explore() const { return inventor_->can_invent(); }
  /// One more sequence.
  void step();

  /// Nothing that may be sent has come to mind for long: there is too little room.
  bool exhausted() const { return barren_ >= 1000; }
  std::uint64_t requests_sent() const { return sent_; }
  std::uint64_t sequences() const { return sequences_; }
  const std::map<std::string, Finding>& findings() const { return findings_; }

  /// How many of the sequences could be judged.
  std::uint64_t judged() const { return judged_; }
  /// What the device was seen to do: by topic and kind of change, how often which outcome.
  using Seen = std::map<std::pair<std::string, std::string>, std::map<std::string, std::uint64_t>>;
  const Seen& seen() const { return seen_; }
  /// Sequences that were not judged, by verdict and reason.
  using Unjudged = std::map<std::pair<results::Verdict, std::string>, std::uint64_t>;
  const Unjudged& unjudged() const { return unjudged_; }

 private:
  results::CaseResult run(const Sequence& sequence, const std::string& id);
  void note(Sequence::Own sequence, const results::CaseResult& result);
  void note_finding(Sequence::Own sequence, const results::CaseResult& result);
  Sequence::Own shortest(Sequence::Own sequence, std::size_t failing, results::Verdict verdict);
  Sequence::Own without_needless_settings(Sequence::Own sequence, results::Verdict verdict);
  bool shows(const Sequence& sequence, results::Verdict verdict);

  Device device_;
  std::unique_ptr<Inventor> inventor_;
  std::uint64_t sent_ = 0, sequences_ = 0, judged_ = 0, barren_ = 0;
  Seen seen_;
  Unjudged unjudged_;
  std::map<std::string, Finding> findings_;
  std::array<vectors::Case, 2>
      running_;  // a bench knows a case by where it is: never the same place twice
  std::size_t turn_ = 0;
};

}  // namespace fieldproof::explore
