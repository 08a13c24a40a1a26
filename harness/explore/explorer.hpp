// Seeded sequences of requests against a device and our own model of it; each difference is a
// finding, made as short as it still shows.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/explore/changes.hpp"
#include "harness/explore/sequence.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::explore {

struct Device {
  const harness::Protocol* protocol = nullptr;  // that knows where the model has its memory
  int station = 1;
  bool over_the_wire = false;  // memory is set by requests; what it did before, it remembers
  std::function<results::CaseResult(const vectors::Case&)> run;
  Room room;  // where requests may go to; none: to all of the memory
  std::function<bool(ByteView request)> allowed = [](ByteView) { return true; };
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
  /// Requests that name memory where there is no room are left out; `can_explore` tells whether any
  /// is left.
  Explorer(Device device, Oracle oracle, std::vector<Request> requests, std::uint64_t seed);

  bool can_explore() const { return !requests_.empty(); }
  /// One more sequence.
  void step();

  /// Nothing that may be sent has come to mind for long: there is too little room.
  bool exhausted() const { return barren_ >= 1000; }
  std::uint64_t requests_sent() const { return sent_; }
  std::uint64_t sequences() const { return sequences_; }
  const std::map<std::string, Finding>& findings() const { return findings_; }

  /// How many of the sequences could be judged.
  std::uint64_t judged() const { return judged_; }
  /// What the device was seen to do: by topic and kind of change, how often which sort of answer.
  using Seen = std::map<std::pair<std::string, std::string>, std::map<std::string, std::uint64_t>>;
  const Seen& seen() const { return seen_; }
  /// Sequences that were not judged, by verdict and reason.
  using Unjudged = std::map<std::pair<results::Verdict, std::string>, std::uint64_t>;
  const Unjudged& unjudged() const { return unjudged_; }

 private:
  struct Sequence {
    std::vector<Request> requests;
    Memory memory;
    std::vector<Answer> answers;
  };
  std::vector<Request> invent();
  std::optional<Request> invent_one(bool faultless, HotWords& hot);
  bool has_room(const Request& request) const;
  bool can_be_sent(const Request& request) const;
  const Request& chosen();
  std::optional<Sequence> answered(std::vector<Request> requests, const Memory* memory);
  results::CaseResult run(const Sequence& sequence, const std::string& id);
  void note(const Sequence& sequence, const results::CaseResult& result);
  Sequence shortest(const Sequence& sequence, std::size_t failing, results::Verdict verdict);
  void note_finding(const Sequence& sequence, const results::CaseResult& result);
  Sequence shortened(Sequence sequence, results::Verdict verdict);
  Sequence without_needless_memory(Sequence sequence, results::Verdict verdict);
  bool shows(const Sequence& sequence, results::Verdict verdict);
  void weigh(const Request& request, const std::string& sort);

  Device device_;
  Oracle oracle_;
  std::vector<Request> requests_;
  std::map<std::string, std::vector<std::size_t>> by_topic_;
  std::map<std::string, std::size_t> weights_;  // of topics: what showed something new weighs more
  Changes changes_;
  Random random_;
  std::uint64_t sent_ = 0, sequences_ = 0, judged_ = 0, barren_ = 0;
  Seen seen_;
  Unjudged unjudged_;
  std::map<std::string, Finding> findings_;
  std::array<vectors::Case, 2>
      running_;  // a bench knows a case by where it is: never the same place twice
  std::size_t turn_ = 0;
};

}  // namespace fieldproof::explore
