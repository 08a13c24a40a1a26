#include "harness/bench/set_up_findings.hpp"

#include <fmt/format.h>

#include "harness/exchange/memory_access.hpp"

namespace fieldproof::bench {

using exchange::set_up_failure;

namespace {

/// "cannot set %MW100: the device answers NAK 1132" without the address.
std::string what_it_did(std::string_view message) {
  message = message.substr(0, message.find(not_tried));
  const std::size_t colon = message.find(": ", set_up_failure.size());
  return std::string(message.substr(colon == message.npos ? 0 : colon + 2));
}

}  // namespace

void SetUpFindings::note(const results::CaseResult& result) {
  if (results::is_judged(result.verdict)) judged_.insert(result.protocol);
  if (result.verdict != results::Verdict::blocked || !result.message.starts_with(set_up_failure))
    return;
  Finding& finding = findings_[result.protocol + "/" + what_it_did(result.message)];
  if (finding.cases++ == 0) finding.first = result;
}

std::vector<results::CaseResult> SetUpFindings::results() const {
  std::vector<results::CaseResult> all;
  for (const auto& [key, finding] : findings_) {
    results::CaseResult result;
    result.id = fmt::format("{}{}/{}", set_up_result, finding.first.protocol, all.size() + 1);
    result.protocol = finding.first.protocol;
    result.title = "The device takes the writes by which the bench sets up its cases";
    result.level = "must";
    result.basis = "derived";
    const bool may_be_lost = finding.cases == 1 &&
                             what_it_did(finding.first.message) == "no answer" &&
                             judged_.contains(finding.first.protocol);
    result.verdict = may_be_lost ? results::Verdict::inconclusive : results::Verdict::fail;
    result.message = fmt::format(
        "{}; {} BLOCKED by it, first {}. {}", finding.first.message.substr(set_up_failure.size()),
        finding.cases == 1 ? "1 case is" : fmt::format("{} cases are", finding.cases),
        finding.first.id,
        may_be_lost ? "Once, while other cases were judged: an answer may have been lost. Run that "
                      "case again"
                    : "Correct the device, or the profile where it declares memory that the device "
                      "does not have");
    result.exchange = finding.first.exchange;
    result.replay = finding.first.replay;
    all.push_back(std::move(result));
  }
  return all;
}

}  // namespace fieldproof::bench
