#include "harness/run/long_texts.hpp"

#include <fmt/format.h>

#include "harness/system/shell_word.hpp"

namespace fieldproof::run {

namespace {

constexpr std::size_t longest = 1000, kept_at_an_end = 400;
constexpr std::size_t worth_a_reference = 200, beginning = 80;
constexpr std::size_t most_kept = 1000;  // notes that a later one may refer to

}  // namespace

std::string bounded(std::string_view text) {
  if (text.size() <= longest) return std::string(text);
  return fmt::format("{} ... ({} characters left out) ... {}", text.substr(0, kept_at_an_end),
                     text.size() - 2 * kept_at_an_end, text.substr(text.size() - kept_at_an_end));
}

std::string not_restored(const std::string& places, const std::string& journal) {
  return fmt::format("NOT RESTORED: {}; type: fieldproof restore {}", bounded(places),
                     os::shell_word(journal));
}

std::string not_sure(const std::string& writes) {
  return fmt::format(
      "NOT SURE that all is as it was: {}; mend the line (cable, termination, ground, speed) and "
      "compare the memory of the device with what it should hold",
      bounded(writes));
}

void LongTexts::shorten(results::CaseResult& result) {
  result.message = bounded(result.message);
  for (results::Difference& one : result.differences)
    for (std::string* text : {&one.expected, &one.received, &one.hint}) *text = bounded(*text);
  for (std::string& note : result.notes) {
    if (note.size() < worth_a_reference) continue;
    note = bounded(note);
    const auto known = seen_.find(note);
    if (known != seen_.end())
      note = fmt::format("{} ..., in full at {}", note.substr(0, beginning), known->second);
    else if (seen_.size() < most_kept)
      seen_.emplace(note, result.id);
  }
}

void LongTexts::shorten_exchange(results::CaseResult& result) {
  constexpr std::size_t kept = 8;
  std::vector<results::Event>& events = result.exchange;
  if (events.size() <= 2 * kept) return;
  results::Event left_out = events[kept];
  left_out = {results::Event::Kind::note, left_out.start, left_out.end, {}, ""};
  left_out.text = fmt::format("{} frames and silences left out", events.size() - 2 * kept);
  events.erase(events.begin() + kept, events.end() - kept);
  events.insert(events.begin() + kept, std::move(left_out));
  result.recording = {};  // it can no longer be judged again
  if (result.response_ms.size() > 2 * kept) result.response_ms.resize(2 * kept);
}

}  // namespace fieldproof::run
