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
#include "harness/explore/shortener.hpp"
#include "harness/protocol.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::explore {

/// The device under test.
struct Device {
  const harness::Protocol* protocol = nullptr;
  std::function<results::CaseResult(const vectors::Case&)> run;
  std::function<bool()> alive = [] { return true; };  // false: no further case can run
  bool real_time = false;  // a silence takes as long as hundreds of answers
};

/// What a sequence showed that the model does not do.
struct Finding {
  vectors::Case shortest;                         // that still shows it
  results::CaseResult result;                     // of it; INCONCLUSIVE where it is not confirmed
  std::map<std::string, std::uint64_t> shown_by;  // topic and kind: so many sequences
  bool confirmed = false;                         // three times in a row; else it was seen once
  int looks = 1;                                  // sequences that were shortened for it
};

class Explorer {
 public:
  Explorer(Device device, std::unique_ptr<Inventor> inventor)
      : device_(std::move(device)), inventor_(std::move(inventor)) {}

  bool can_explore() const { return inventor_->can_invent(); }
  /// One more sequence.
  void step();

  /// Nothing that may be sent has come to mind for long: there is too little room.
  bool exhausted() const { return barren_ >= enough_barren; }
  std::uint64_t requests_sent() const { return sent_; }
  std::uint64_t sequences() const { return sequences_; }
  /// By mark.
  const std::map<std::string, Finding>& findings() const { return findings_; }

  /// How many of the sequences could be judged.
  std::uint64_t judged() const { return judged_; }
  /// What the device was seen to do: by topic and kind of change, how often which outcome.
  using Seen = std::map<std::pair<std::string, std::string>, std::map<std::string, std::uint64_t>>;
  const Seen& seen() const { return seen_; }
  Inventor::Known known() const { return inventor_->known(); }
  /// Sequences that were not judged, by verdict and reason.
  struct Unjudged {
    std::uint64_t times = 0;
    results::CaseResult first{};
  };
  using AllUnjudged = std::map<std::pair<results::Verdict, std::string>, Unjudged>;
  const AllUnjudged& unjudged() const { return unjudged_; }

 private:
  static constexpr std::uint64_t enough_barren = 1000, requests_for_a_silence = 10;

  results::CaseResult run(const Sequence& sequence, const std::string& id);
  bool waits_too_long(std::uint64_t silences) const;
  void note(Sequence::Own sequence, const results::CaseResult& result);
  void note_as_expected(const Sequence& sequence);
  void note_unjudged(const Sequence& sequence, const results::CaseResult& result);
  void count_unjudged(results::Verdict verdict, const std::string& why,
                      const results::CaseResult& result);
  bool learnt(const Sequence& sequence, std::size_t failing, const results::CaseResult& result);
  bool known_already(const Sequence& sequence, std::size_t failing,
                     const results::CaseResult& result, const std::string& mark);
  void look_into(Sequence::Own sequence, std::size_t failing, const results::CaseResult& result,
                 const std::string& mark);
  Finding finding_of(const Sequence& found, Shortener& shortener, results::CaseResult seen,
                     const std::string& id);

  Device device_;
  std::unique_ptr<Inventor> inventor_;
  std::uint64_t sent_ = 0, sequences_ = 0, judged_ = 0, barren_ = 0, silences_ = 0;
  Seen seen_;
  AllUnjudged unjudged_;
  std::map<std::string, Finding> findings_;
  std::map<std::string, std::string> same_;  // the mark of a long sequence: that of its finding
  std::array<vectors::Case, 2>
      running_;  // a bench knows a case by where it is: never the same place twice
  std::size_t turn_ = 0;
};

}  // namespace fieldproof::explore
