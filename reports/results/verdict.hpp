// The verdicts of a case and what each means for the gate.
#pragma once

#include <optional>
#include <string_view>

namespace fieldproof::results {

enum class Verdict {
  pass,          // as the manual says
  marginal,      // within limits, inside the guard band
  non_strict,    // an allowed alternative, or a SHOULD missed
  info,          // measured, the manual gives no limit
  fail,          // violates a MUST
  xfail,         // waived failure
  xpass,         // a waiver that no longer holds
  skip,          // outside the profile of the device
  blocked,       // needs a permission, fixture or mode not given
  inconclusive,  // the bench cannot judge (not read, noise, timing floor)
  error          // port, emulator, vector or harness trouble: the state before judging
};

/// "PASS", "NON-STRICT", ...
std::string_view to_string(Verdict verdict);
/// The reverse; nothing for an unknown word.
std::optional<Verdict> parse_verdict(std::string_view text);

/// A verdict on the device: not SKIP, BLOCKED, INCONCLUSIVE or ERROR.
bool is_judged(Verdict verdict);

/// Which verdicts turn the gate red, by the options of the run.
struct Gate {
  bool strict = false;            // --strict: NON-STRICT fails
  bool fail_on_marginal = false;  // --fail-on marginal
  bool qualify = false;           // --qualify: BLOCKED and INCONCLUSIVE fail
  double min_judged = 0;          // --min-judged: percent of what the profile declares
};
/// ERROR always gates, FAIL and XPASS always fail.
bool gates(Verdict verdict, const Gate& gate);

}  // namespace fieldproof::results
