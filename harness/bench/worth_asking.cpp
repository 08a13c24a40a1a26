#include "harness/bench/worth_asking.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::bench {

namespace {

using results::Event;

constexpr int most_doubt = 20;  // cases without a whole frame; those that take long count for more
constexpr int fruitful = 10;    // cases that pass after a restart
constexpr int most_fruitless = 3;

bool begins_with_frame(ByteView came, const harness::Protocol& protocol) {
  const auto length = protocol.frame_length(came);
  if (!length) return false;
  const std::vector<harness::Field> fields = protocol.explain(ByteView(came).first(*length));
  return !fields.empty() && fields.front().problem.empty();
}

/// Did a whole frame come, or an end of a connection, which is an answer of its own? Two halves,
/// answers to two requests, are none.
bool anything_whole(const results::CaseResult& result, const harness::Protocol& protocol) {
  Bytes came;  // since the last request
  for (const Event& event : result.exchange) {
    if (event.by_device) return true;
    if (event.kind == Event::Kind::sent && begins_with_frame(came, protocol)) return true;
    if (event.kind == Event::Kind::sent) came.clear();
    if (event.kind == Event::Kind::received)
      came.insert(came.end(), event.bytes.begin(), event.bytes.end());
  }
  return begins_with_frame(came, protocol);
}

}  // namespace

std::string WorthAsking::after(const results::CaseResult& result, const harness::Protocol& protocol,
                               bool set_up) {
  passed_ += result.verdict == results::Verdict::pass;
  const bool asked = std::ranges::any_of(
      result.exchange, [](const Event& event) { return event.kind == Event::Kind::sent; });
  if ((!asked && set_up) || !protocol.has_frame_ends()) return {};
  if (!result.recording.flooded && anything_whole(result, protocol)) {
    doubt_ = 0;
    return {};
  }
  doubt_ += result.recording.flooded || !set_up ? 5 : 1;
  if (doubt_ < most_doubt) return {};
  return fmt::format(
      "no whole frame came from the device in the last cases, up to {}: {}. Further cases would "
      "say the same",
      result.id, result.message);
}

std::string WorthAsking::restart(const results::CaseResult& result, bool odd) {
  if (!odd) fruitless_ = restarts_ == 0 || passed_ >= fruitful ? 0 : fruitless_ + 1;
  passed_ = 0;
  doubt_ = 0;  // it answers when it is up again, or the run ends
  if (fruitless_ == most_fruitless)
    return fmt::format(
        "the device was started again {} times, and fell mute or sent without end in ordinary "
        "requests each time before {} cases had passed, the last time in {}; it is not started "
        "again",
        most_fruitless, fruitful, result.id);
  if (restarts_++ < max_restarts_) return {};
  return fmt::format(
      "the device was lost {} times (it ended, fell mute or sent without end), the last time in "
      "{}; it is not started again (--max-restarts {})",
      restarts_, result.id, max_restarts_);
}

}  // namespace fieldproof::bench
