#include "harness/judge/recording.hpp"

#include <fmt/format.h>
#include <algorithm>

#include "harness/vectors/fingerprint.hpp"

namespace fieldproof::judging {

using exchange::PreparedCase;
using exchange::Transcript;
using results::Event;
using vectors::Step;

namespace {

// ---- writing
// -------------------------------------------------------------------------------------------------------

/// Bytes of one event that one step took, or that were surplus.
struct Claim {
  std::size_t event = 0, offset = 0, size = 0;
  Time start{}, end{};
  int step = -1;
  bool surplus = false;
};

void claim(const exchange::Received& received, int step, bool surplus, std::vector<Claim>& claims) {
  for (std::size_t i = 0; i < received.arrivals.size(); ++i) {
    const exchange::Received::Arrival& one = received.arrivals[i];
    const std::size_t end =
        i + 1 < received.arrivals.size() ? received.arrivals[i + 1].offset : received.bytes.size();
    claims.push_back(
        {one.event, one.event_offset, end - one.offset, one.start, one.end, step, surplus});
  }
}

std::vector<Claim> claims_of(const Transcript& transcript) {
  std::vector<Claim> claims;
  for (std::size_t i = 0; i < transcript.steps.size(); ++i)
    claim(transcript.steps[i].received, static_cast<int>(i), false, claims);
  claim(transcript.surplus, -1, true, claims);
  std::ranges::stable_sort(claims, {},
                           [](const Claim& one) { return std::pair(one.event, one.offset); });
  return claims;
}

Event part_of(const Event& event, std::size_t from, std::size_t to) {
  Event part = event;
  part.bytes.assign(event.bytes.begin() + static_cast<std::ptrdiff_t>(from),
                    event.bytes.begin() + static_cast<std::ptrdiff_t>(to));
  return part;
}

/// All that is done to the device, in a text of no other use. What is expected of it is left out:
/// that may change.
std::string stimulus_text(const PreparedCase& prepared) {
  const vectors::Case& source = *prepared.source;
  std::string text =
      fmt::format("{} {} {}\n", prepared.station, source.fresh, source.config.dump());
  const auto add_memory = [&](const std::vector<std::pair<std::string, std::string>>& memory) {
    for (const auto& [address, hex] : memory) text += fmt::format("{}={} ", address, hex);
  };
  add_memory(source.memory);
  for (const exchange::PreparedStep& step : prepared.steps) {
    text += fmt::format("\n{} x{} {} {} ", static_cast<int>(step.step->kind), step.step->times,
                        step.step->action, step.step->duration.count());
    if (step.step->kind == Step::Kind::set) add_memory(step.step->memory);
    if (step.step->kind == Step::Kind::check)
      for (const auto& [address, hex] : step.step->memory)
        text += fmt::format("{}:{} ", address, hex.size());
    if (const std::optional<vectors::PartnerSpec>& partner = step.step->partner) {
      text += fmt::format("{} {} {} ", partner->model, partner->config.dump(), partner->fault);
      add_memory(partner->memory);
    }
    if (step.step->kind != Step::Kind::send) continue;
    const notation::FrameTemplate& frame = step.frames.front().frame;
    text += notation::to_hex_with_holes(frame);
    for (const std::string& name : frame.names) text += " {" + name + "}";
    for (const notation::FrameTemplate::Gap& gap : frame.gaps)
      text +=
          fmt::format(" ~{}:{}{}", gap.before, gap.pause.amount, gap.pause.characters ? "c" : "");
  }
  return text;
}

std::string stimulus_of(const PreparedCase& prepared) {
  return fmt::format(
      "{:016x}", vectors::extend_fingerprint(vectors::empty_fingerprint, stimulus_text(prepared)));
}

// ---- reading
// -------------------------------------------------------------------------------------------------------

void take_event(const Event& event, Transcript& transcript) {
  transcript.events.push_back(event);
  const bool of_step =
      event.step >= 0 && static_cast<std::size_t>(event.step) < transcript.steps.size();
  if (event.kind == Event::Kind::sent && of_step) {
    exchange::StepRecord& record = transcript.steps[static_cast<std::size_t>(event.step)];
    if (record.sent_bytes.empty()) record.sent.start = event.start;
    record.sent.end = event.end;
    record.sent_bytes.insert(record.sent_bytes.end(), event.bytes.begin(), event.bytes.end());
  }
  if (event.kind != Event::Kind::received || event.bytes.empty() || !(of_step || event.surplus))
    return;
  exchange::Received& received =
      event.surplus ? transcript.surplus
                    : transcript.steps[static_cast<std::size_t>(event.step)].received;
  received.arrivals.push_back({received.bytes.size(), event.start, event.end});
  received.bytes.insert(received.bytes.end(), event.bytes.begin(), event.bytes.end());
}

/// The step of the vector that each executed step was: `times` repeats them.
std::vector<const Step*> executed_steps(const PreparedCase& prepared, std::size_t count) {
  std::vector<const Step*> steps;
  for (const exchange::PreparedStep& step : prepared.steps)
    for (int i = 0; i < step.step->times && steps.size() < count; ++i) steps.push_back(step.step);
  return steps;
}

}  // namespace

std::vector<Event> recorded_events(const Transcript& transcript) {
  const std::vector<Claim> claims = claims_of(transcript);
  std::vector<Event> events;
  auto next = claims.begin();
  for (std::size_t i = 0; i < transcript.events.size(); ++i) {
    const Event& event = transcript.events[i];
    std::size_t done = 0;
    for (; next != claims.end() && next->event == i; ++next) {
      if (next->offset > done) events.push_back(part_of(event, done, next->offset));
      done = next->offset + next->size;
      Event part = part_of(event, next->offset, done);
      part.start = next->start;
      part.end = next->end;
      part.step = next->step;
      part.surplus = next->surplus;
      events.push_back(std::move(part));
    }
    if (done == 0 || done < event.bytes.size())
      events.push_back(part_of(event, done, event.bytes.size()));
  }
  return events;
}

results::Recording make_recording(const PreparedCase& prepared, const Transcript& transcript,
                                  const JudgeRules& rules) {
  results::Recording recording;
  if (transcript.trouble) return recording;  // the bench's own: there is nothing to judge
  recording.stimulus = stimulus_of(prepared);
  recording.station = prepared.station;
  for (const exchange::StepRecord& step : transcript.steps)
    recording.steps.push_back({step.stimulus, step.memory, step.refused, step.refused_by_device});
  recording.flooded = transcript.flooded;
  recording.dead = transcript.dead;
  recording.timing_floor = rules.timing_floor;
  recording.link_floor = rules.link_floor;
  recording.max_gap = rules.max_gap;
  recording.period_tolerance = rules.period_tolerance;
  return recording;
}

Result<Transcript> replay(const results::CaseResult& recorded, const PreparedCase& prepared,
                          Duration response_max) {
  const results::Recording& recording = recorded.recording;
  if (recording.stimulus.empty()) {
    return fail(recorded.exchange.empty() ? "nothing was exchanged"
                                          : "the exchange was recorded without its steps, by an "
                                            "older version; run the case again");
  }
  if (recording.stimulus != stimulus_of(prepared))
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
    record.stimulus = outcome.stimulus;
    record.deadline = outcome.stimulus + exchange::reply_limit(*steps[i], response_max);
    record.memory = outcome.memory;
    record.refused = outcome.refused;
    record.refused_by_device = outcome.refused_by_device;
  }
  for (const Event& event : recorded.exchange) take_event(event, transcript);
  transcript.flooded = recording.flooded;
  transcript.dead = recording.dead;
  return transcript;
}

}  // namespace fieldproof::judging
