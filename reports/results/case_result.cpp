#include "reports/results/case_result.hpp"

#include <algorithm>
#include <optional>

namespace fieldproof::results {

std::string_view to_string(Event::Kind kind) {
  switch (kind) {
    case Event::Kind::sent: return "sent";
    case Event::Kind::received: return "received";
    case Event::Kind::opened: return "opened";
    case Event::Kind::closed: return "closed";
    case Event::Kind::reset: return "reset";
    case Event::Kind::note: break;
  }
  return "note";
}

Time shown_from(const CaseResult& result) {
  std::optional<Time> first;
  const auto consider = [&](Time at) { first = std::min(first.value_or(at), at); };
  if (!result.exchange.empty()) consider(result.exchange.front().start);
  for (const AxisTrace& axis : result.trace.axes)
    if (!axis.samples.empty()) consider(axis.samples.front().time);
  for (const NetTrace& net : result.trace.nets)
    if (!net.turns.empty()) consider(net.turns.front().from);
  return first.value_or(Time{});
}

void shift(CaseResult& result, Duration by) {
  const auto later = [by](auto&... times) { ((times += by), ...); };
  for (Event& event : result.exchange) later(event.start, event.end);
  for (StepOutcome& step : result.recording.steps)
    if (step.timed) later(step.stimulus);
  if (!result.due.empty()) later(result.due.from, result.due.until);
  for (AxisTrace& axis : result.trace.axes) {
    for (AxisTrace::Sample& sample : axis.samples) later(sample.time);
    for (AxisTrace::Event& event : axis.events) later(event.time);
  }
  for (NetTrace& net : result.trace.nets)
    for (TokenTurn& turn : net.turns) later(turn.from, turn.to);
}

Identity in_common(Identity a, const Identity& b) {
  for (std::string Identity::*field :
       {&Identity::name, &Identity::maker, &Identity::model, &Identity::serial, &Identity::firmware,
        &Identity::operator_name, &Identity::notes})
    if (a.*field != b.*field) (a.*field).clear();
  if (a.fingerprint != b.fingerprint) a.fingerprint.clear();
  if (a.fingerprint_found != b.fingerprint_found) a.fingerprint_found.clear();
  return a;
}

void RunEnd::add(Reason reason) {
  reasons.push_back(std::move(reason));
  exit_code = exit_code_of(reasons);
}

}  // namespace fieldproof::results
