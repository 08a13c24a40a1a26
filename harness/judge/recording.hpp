// An exchange as a result file keeps it, and back: so that a recorded run can be judged again,
// without the device.
#pragma once

#include "harness/judge/judge.hpp"

namespace fieldproof::judging {

/// What `replay` needs besides the events.
results::Recording make_recording(const exchange::PreparedCase& prepared,
                                  const exchange::Transcript& transcript, const JudgeRules& rules);

/// The transcript of a recorded result, ready for the judge. Limits are those of today's vector and
/// of `response_max`. Errors say why the exchange cannot be judged: nothing was recorded, or the
/// case no longer does the same to the device.
Result<exchange::Transcript> replay(const results::CaseResult& recorded,
                                    const exchange::PreparedCase& prepared, Duration response_max);

}  // namespace fieldproof::judging
