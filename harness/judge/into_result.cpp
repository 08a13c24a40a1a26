#include <fmt/format.h>

#include <algorithm>

#include "harness/judge/judge.hpp"

namespace fieldproof::judging {

namespace {

void cite(const vectors::Source& source, results::CaseResult& result) {
  result.manual = source.manual;
  result.section = source.section;
  result.quote = source.quote;
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
  result.received = notation::print_bytes(judgement.received.bytes);
  result.received_bytes = std::move(judgement.received.bytes);
}

}  // namespace fieldproof::judging
