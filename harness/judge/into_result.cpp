#include <fmt/format.h>

#include <algorithm>

#include "harness/judge/judge.hpp"
#include "harness/judge/token_rules.hpp"
#include "reports/results/extract.hpp"

namespace fieldproof::judging {

namespace {

void cite(const vectors::Source& source, results::CaseResult& result) {
  result.manual = source.manual;
  result.section = source.section;
  result.quote = source.quote;
}

std::string in_notation(ByteView bytes, const results::Extract& extract) {
  const std::string text = notation::print_bytes(bytes);
  if (extract.empty()) return text;
  return fmt::format("{} ... ({} bytes left out) ... {}", text, extract.left_out(bytes.size()),
                     notation::print_bytes(extract.tail));
}

bool follows(const results::Event& event, const results::Event& before, Duration apart) {
  constexpr auto received = results::Event::Kind::received;
  return event.kind == received && before.kind == received && !event.bytes.empty() &&
         event.start - before.end <= apart && event.step == before.step &&
         event.surplus == before.surplus && event.link == before.link;
}

void join_pieces(std::vector<results::Event>& events, Duration apart) {
  std::vector<results::Event> joined;
  for (results::Event& event : events) {
    if (joined.empty() || !follows(event, joined.back(), apart)) {
      joined.push_back(std::move(event));
      continue;
    }
    joined.back().end = event.end;
    joined.back().bytes.insert(joined.back().bytes.end(), event.bytes.begin(), event.bytes.end());
  }
  events = std::move(joined);
}

}  // namespace

results::CaseResult result_of(const vectors::Case& source) {
  results::CaseResult result;
  result.id = source.id;
  result.rev = source.rev;
  result.protocol = source.protocol;
  result.title = source.title;
  result.level = source.level;
  result.basis = source.basis;
  result.on_model = source.on_model;
  cite(source.source, result);
  return result;
}

void note_transposition(const exchange::PreparedCase& prepared, results::CaseResult& result) {
  if (prepared.is_client()) return;  // a client's own station is nowhere on the line
  const int named =
      vectors::config_station(prepared.source->config, prepared.station).value_or(prepared.station);
  if (named != prepared.station)
    result.notes.push_back(fmt::format("transposed: station {} to {}", named, prepared.station));
}

void take_judgement(Judgement judgement, results::CaseResult& result) {
  // The reader wants the clause that was broken, not that of the whole case.
  if (judgement.failed && !judgement.failed->source.quote.empty())
    cite(judgement.failed->source, result);
  result.verdict = judgement.verdict;
  result.message = std::move(judgement.message);
  std::ranges::move(judgement.notes, std::back_inserter(result.notes));
  result.differences = std::move(judgement.differences);
  result.readings = std::move(judgement.readings);
  result.response_ms = std::move(judgement.response_ms);
  if (judgement.expected) {
    result.expected = judgement.expected->source->text;
    result.expected_bytes = judgement.expected->frame.bytes;
    result.expected_hex = notation::to_hex_with_holes(judgement.expected->frame);
  }
  if (judgement.failed && judgement.failed->kind == vectors::Step::Kind::expect)
    result.due = judgement.due;
  result.received = notation::print_bytes(judgement.received.bytes);
  result.received_bytes = std::move(judgement.received.bytes);
}

void take_exchange(const exchange::Transcript& transcript, std::size_t longest_frame,
                   results::CaseResult& result, Duration apart) {
  const std::size_t most = 2 * longest_frame;  // a frame, and one that nobody waits for
  result.received_extract = results::cut(result.received_bytes, most);
  if (!result.received_extract.empty())
    result.received = in_notation(result.received_bytes, result.received_extract);
  std::vector<results::Event> events(transcript.events.begin(), transcript.events.end());
  if (apart > 0ns) join_pieces(events, apart);
  results::cut_runs(events, most);
  for (results::Event& event : events) {
    if (event.kind == results::Event::Kind::sent || event.kind == results::Event::Kind::received)
      event.text = in_notation(event.bytes, event.extract);
    result.exchange.push_back(std::move(event));
  }
  result.trace = transcript.trace;
  // Who had the token matters to timing, and where it broke a rule.
  if (result.on_model != "timing")
    std::erase_if(result.trace.nets,
                  [](const NetTrace& net) { return broken_token_rule(net).empty(); });
}

}  // namespace fieldproof::judging
