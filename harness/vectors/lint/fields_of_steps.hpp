// What the moving fields of a notation are on the link of each step of a case.
#pragma once

#include <map>
#include <string>

#include "harness/protocols.hpp"
#include "harness/vectors/link_names.hpp"

namespace fieldproof::vectors {

/// Goes through the steps of a case in their order. The case and the protocols outlive it.
class FieldsOfSteps {
 public:
  FieldsOfSteps(const Case& one, const harness::Protocol& own, const harness::Protocols& known)
      : one_(one), own_(own), known_(known), links_(one, own.on_network()) {}

  /// At the station that the vector gives. Errors: its link is not open, or nobody knows what is
  /// spoken there.
  Result<notation::Fields> next(const Step& step);

 private:
  const Case& one_;
  const harness::Protocol& own_;
  const harness::Protocols& known_;
  LinkNames links_;
  std::map<std::string, const harness::Protocol*> services_;  // by link
};

}  // namespace fieldproof::vectors
