// An exchange as a result file keeps it, and back: so that a recorded run can be judged again,
// without the device.
#pragma once

#include "harness/judge/judge.hpp"

namespace fieldproof {

/// The frame monitor's events, each with the step that took its bytes; a burst of which two steps
/// took a part is two.
std::vector<Event> recorded_events(const Transcript& transcript);

/// What `replay` needs besides the events.
Recording make_recording(const PreparedCase& prepared, const Transcript& transcript,
                         const JudgeRules& rules);

/// The transcript of a recorded result, ready for the judge. Limits are those of today's vector and
/// of `response_max`. Errors say why the exchange cannot be judged: nothing was recorded, or the
/// case no longer does the same to the device.
Result<Transcript> replay(const CaseResult& recorded, const PreparedCase& prepared,
                          Duration response_max);

}  // namespace fieldproof
