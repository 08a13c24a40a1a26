#include "harness/judge/recording.hpp"

#include <fmt/format.h>

namespace fieldproof::judging {

using exchange::PreparedCase;
using exchange::Transcript;
using results::Event;
using vectors::Step;

namespace {

/// The step of the vector that each executed step was: `times` repeats them.
std::vector<const Step*> executed_steps(const PreparedCase& prepared, std::size_t count) {
  std::vector<const Step*> steps;
  for (const exchange::PreparedStep& step : prepared.steps)
    for (int i = 0; i < step.step->times && steps.size() < count; ++i) steps.push_back(step.step);
  return steps;
}

}  // namespace

results::Recording make_recording(const PreparedCase& prepared, const Transcript& transcript,
                                  const JudgeRules& rules) {
  results::Recording recording;
  if (transcript.trouble) return recording;  // the bench's own: there is nothing to judge
  recording.stimulus = prepared.stimulus;
  recording.station = prepared.station;
  for (const exchange::StepRecord& step : transcript.steps)
    recording.steps.push_back({step.cause, step.memory, step.refused, step.refused_by_device,
                               step.passed_over, step.cause != Time{} || step.deadline != Time{}});
  recording.flooded = transcript.flooded;
  recording.dead = transcript.dead;
  recording.timing_floor = rules.timing_floor;
  recording.link_floor = rules.link_floor;
  recording.earliest = rules.earliest;
  recording.gap_floor = rules.gap_floor;
  recording.max_gap = rules.max_gap;
  recording.period_tolerance = rules.period_tolerance;
  return recording;
}

Result<Transcript> replay(const results::CaseResult& recorded, const PreparedCase& prepared,
                          Duration response_max) {
  const results::Recording& recording = recorded.recording;
  for (const Event& event : recorded.exchange)
    if (!event.extract.empty())
      return fail(
          fmt::format("not all bytes were kept: {} came in a row, and the record has both "
                      "ends of them; run the case again",
                      event.extract.count));
  if (recording.stimulus.empty()) {
    return fail(recorded.exchange.empty() ? "nothing was exchanged"
                                          : "the exchange was recorded without its steps, by an "
                                            "older version; run the case again");
  }
  if (recording.stimulus != prepared.stimulus)
    return fail(
        "the vector no longer does the same to the device as when this was recorded; run the case "
        "again");
  Transcript transcript;
  const std::vector<const Step*> steps = executed_steps(prepared, recording.steps.size());
  if (steps.size() != recording.steps.size())
    return fail("the recording has more steps than the case; the file is damaged");
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const results::StepOutcome& outcome = recording.steps[i];
    exchange::StepRecord& record = transcript.steps.emplace_back();
    record.cause = outcome.stimulus;
    record.deadline = outcome.stimulus + prepared.reply_limit(*steps[i], response_max);
    record.memory = outcome.memory;
    record.refused = outcome.refused;
    record.refused_by_device = outcome.refused_by_device;
    record.passed_over = outcome.passed_over;
  }
  transcript.events = {recorded.exchange.begin(), recorded.exchange.end()};
  transcript.trace = recorded.trace;
  transcript.flooded = recording.flooded;
  transcript.dead = recording.dead;
  return transcript;
}

}  // namespace fieldproof::judging
