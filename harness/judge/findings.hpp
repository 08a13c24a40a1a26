// What the judge has found of a case so far: the gravest verdict, and the first miss in words.
#pragma once

#include <string>

#include "harness/judge/judge.hpp"

namespace fieldproof::judging {

class Findings {
 public:
  Findings() { result.verdict = results::Verdict::pass; }

  /// The first miss names the case; its verdict is settled by level and basis at the end.
  void miss(std::string message);
  /// A verdict short of a miss: the gravest one stays.
  void lower_to(results::Verdict verdict, std::string message);
  /// A limit of time that binds only where the profile says so.
  void miss_or_lower(bool binding, std::string message);
  /// Something that is not the device's doing ends the case.
  void block(std::string message);
  /// A miss that counts although the case was blocked before it came out. Beside another one it is
  /// a note.
  void miss_in_any_case(std::string message);
  bool missed() const { return missed_; }

  /// A miss as the case's level and basis have it.
  void settle(const vectors::Case& source, const vectors::Binding& decisions);

  Judgement result;

 private:
  bool missed_ = false;
};

}  // namespace fieldproof::judging
