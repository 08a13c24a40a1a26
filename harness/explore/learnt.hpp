// What a device answers where no manual and no decision says what is right: its own reading of
// them, to which it is held from then on.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "harness/explore/oracle.hpp"
#include "harness/explore/request.hpp"

namespace fieldproof::explore {

/// What the device answered to one request, where our own device answers one sort.
struct Reading {
  Answer answer;
  std::string sort;      // of the answer
  std::string own_sort;  // of our own device's
  std::string what;      // "rss/field"
};

class Learnt {
 public:
  /// The same request, where our own device answers the same sort to it.
  static std::string key_of(const Request& request, const std::string& own_sort);

  const Reading* find(const std::string& key) const;
  /// The first of a key stays.
  void learn(const std::string& key, const Request& request, Reading reading);
  /// Requests that the device answers otherwise than our own; to be asked again and again.
  const std::vector<Request>& otherwise() const { return otherwise_; }

  /// "rss/field: silence here, 1234 on the device (12 requests; ENQ '01' ..)".
  std::vector<std::string> lines() const;

 private:
  std::map<std::string, Reading> readings_;
  std::vector<Request> otherwise_;
};

}  // namespace fieldproof::explore
