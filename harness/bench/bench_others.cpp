// A line behind a serial server, which others may reach, too: what they ask is answered to all.
#include <fmt/format.h>

#include <algorithm>

#include "harness/bench/bench.hpp"
#include "harness/exchange/memory_access.hpp"
#include "harness/notation/beginning.hpp"

namespace fieldproof::bench {

using exchange::PreparedCase;
using results::CaseResult;
using results::Event;
using results::Verdict;

namespace {

constexpr Duration claim_watch = 700ms, doubt_watch = 1s;
/// So long the bench goes on asking after it has heard somebody, so that a case of theirs which it
/// has spoilt meets it, too.
constexpr Duration farewell = 2s;
constexpr Duration doubt_lasts = 10s;
constexpr int most_disturbed = 5;  // then they are here to stay

std::string somebody_speaks(const endpoints::Endpoint& endpoint, const std::string& what) {
  return fmt::format(
      "somebody else speaks on {}: {}. Its server lets several clients in: end the other one, or "
      "let it in alone (ser2net.yaml: max-connections: 1; labgrid: acquire the place for one "
      "client). A device that sends unasked itself is judged with shared=off behind the '?' of the "
      "endpoint",
      endpoint.describe(), what);
}

bool has_unasked_bytes(const CaseResult& result) {
  return std::ranges::any_of(result.exchange, [](const Event& event) {
    return event.surplus && event.kind == Event::Kind::received;
  });
}

bool may_be_spoilt(const CaseResult& result) {
  return result.verdict == Verdict::fail || (result.verdict == Verdict::blocked &&
                                             result.message.starts_with(exchange::set_up_failure));
}

}  // namespace

/// Before the first case: is the bench alone? The error says who is not.
Status Bench::claim() {
  if (!endpoint_.capabilities().shared || known_->claimed) return ok();
  const Result<Bytes> heard = exchange_.unasked_bytes(options_.station, claim_watch);
  if (!heard) return heard.error();
  known_->claimed = heard->empty() || !endpoint_.lets_others_in();
  if (known_->claimed) return ok();
  static_cast<void>(exchange_.unasked_bytes(options_.station, farewell));
  return fail(
      somebody_speaks(endpoint_, fmt::format("{} bytes came that the bench had not asked for ({})",
                                             heard->size(), notation::print_beginning(*heard))));
}

/// Does what somebody else says explain how the case went? Looks, where nothing has been heard yet.
Result<bool> Bench::is_disturbed(const CaseResult& result) {
  if (has_unasked_bytes(result)) return true;
  if (!may_be_spoilt(result)) return false;
  if (endpoint_.now() < known_->doubt_until) return true;
  const Result<Bytes> heard = exchange_.unasked_bytes(options_.station, doubt_watch);
  if (!heard) return heard.error();
  return !heard->empty();
}

/// What may be their work is no failure of the device.
void Bench::look_for_others(const PreparedCase& prepared, CaseResult& result) {
  if (prepared.is_client() || known_->port_failed) return;
  const Result<bool> disturbed = is_disturbed(result);
  if (!disturbed) return recovery_.stop("the port failed after " + result.id, &disturbed.error());
  if (!*disturbed || !endpoint_.lets_others_in()) {
    if (endpoint_.now() >= known_->doubt_until) known_->disturbed = 0;
    return;
  }
  result.notes.push_back(fmt::format("nobody else heard, it would be {}: {}",
                                     to_string(result.verdict), result.message));
  result.verdict = Verdict::inconclusive;
  result.message = somebody_speaks(endpoint_, "bytes came that this case had not asked for");
  result.recording = {};  // what others have spoilt is not judged again
  known_->doubt_until = endpoint_.now() + doubt_lasts;
  if (++known_->disturbed == most_disturbed && known_->stopped.empty())
    recovery_.stop(fmt::format("{} (heard in {} cases, the last is {})", result.message,
                               most_disturbed, result.id));
}

}  // namespace fieldproof::bench
