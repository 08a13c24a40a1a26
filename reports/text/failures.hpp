// The same failure again and again is one finding: a device that has fallen silent fails a thousand
// cases in one way.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"

namespace fieldproof::text {

/// What a message says without the values of its case: "no answer within # ms", "BCC: expected #,
/// got #".
std::string kind_of(const std::string& message);

/// Cases that failed alike: by the verdict, and the kind of their message.
struct Finding {
  std::size_t number = 0;  // from 1, in the order in which they came up
  std::size_t cases = 0;
  std::string message;             // of the first
  std::vector<std::string> first;  // labels of the first that are told in full
  bool alike = true;               // all have that very message

  /// Is it told in full no more?
  bool is_again() const { return cases > first.size(); }
};

/// "1,514 cases: no answer within 500 ms (first: xgt_cnet/rss/one_word, ...)".
std::string to_string(const Finding& finding);

class Failures {
 public:
  /// How many cases of a finding are told in full: those that it names.
  static constexpr std::size_t in_full = 3;

  /// One more; the finding that it belongs to, with it.
  const Finding& add(const results::CaseResult& result);

  /// In the order in which they came up.
  std::vector<const Finding*> all() const;
  /// With more cases than are told in full; the greatest first.
  std::vector<const Finding*> repeated() const;
  /// Labels of all other cases, in their order.
  std::vector<std::string> single() const;

 private:
  struct Known {
    Finding finding;
    std::vector<std::size_t> at;  // of `first`, among all cases
  };
  std::map<std::string, Known> known_;  // by verdict and kind
  std::size_t cases_ = 0;
};

}  // namespace fieldproof::text
