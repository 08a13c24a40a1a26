// Known failures that the team accepts for a while. A waiver that no longer does what it says turns
// the gate red.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "reports/results/case_result.hpp"
#include "src/base/result.hpp"

namespace fieldproof::bench {

struct Waiver {
  std::string id;  // of a case, or a glob
  std::string reason, owner;
  std::string text;     // must be part of the failure's message
  std::string expires;  // ISO date, the last day on which it holds
  std::string firmware_from,
      firmware_to;  // holds for these versions alone, both included; empty: open on this side
};

/// Reads [{"id","reason","owner","text","expires","firmware":{"from"?,"to"?}?}]. Errors name file
/// and entry.
Result<std::vector<Waiver>> parse_waivers(const std::string& text, const std::string& file);
/// An empty path: there are none.
Result<std::vector<Waiver>> load_waivers(const std::string& path);

/// Begins the id of a result that speaks of a waiver, not of a case: "waiver/xgt_cnet/*".
inline constexpr std::string_view waiver_result = "waiver/";

/// What a run does with its waivers: each failure that one covers, and at the end those that cover
/// none.
class Waivers {
 public:
  /// `today` is an ISO date; `firmware` is the device's as entered, empty where nobody did.
  Waivers(std::vector<Waiver> waivers, std::string today, std::string firmware)
      : waivers_(std::move(waivers)), today_(std::move(today)), firmware_(std::move(firmware)) {}
  Waivers() = default;

  /// FAIL becomes XFAIL while a waiver holds; otherwise the failure stays and a note says what
  /// became of the waiver. A case that is waived by its own id and no longer fails is XPASS.
  void apply(results::CaseResult& result);

  /// One XPASS for each glob of whose cases (`ids` being all there are) none failed, although at
  /// least `enough_judged` of those that this device could fail were judged.
  std::vector<results::CaseResult> superfluous(const std::vector<std::string>& ids) const;

 private:
  enum class Firmware { covered, other, unknown };
  Firmware firmware_of(const Waiver& waiver) const;
  const Waiver* find(const std::string& id) const;

  std::vector<Waiver> waivers_;
  std::string today_, firmware_;
  static constexpr double enough_judged = 0.9;
  enum class Came { skipped, unjudged, held, failed };
  std::map<std::string, Came> came_;  // of the cases that a waiver selects, the gravest
};

/// "no case 'xgt_cnet/rss/two_wrds'; did you mean ..." for each waiver that selects none of `ids`.
std::vector<std::string> unknown_targets(const std::vector<Waiver>& waivers,
                                         const std::vector<std::string>& ids);

/// Compares versions by their numbers: "V1.10" is newer than "1.9". Negative, 0, positive.
int compare_versions(std::string_view a, std::string_view b);

}  // namespace fieldproof::bench
