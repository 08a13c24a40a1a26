#include "reports/text/failures.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <utility>

#include "reports/text/case_text.hpp"
#include "reports/text/tally.hpp"

namespace fieldproof::text {

namespace {

constexpr std::size_t longest_kind = 120;
constexpr std::size_t most_kinds = 1000;  // what is of a further kind counts as such alone

bool is_of_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// A number, an address, bytes in hex.
bool is_value(std::string_view word) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_hex = [&](char c) { return is_digit(c) || (c >= 'A' && c <= 'F'); };
  return std::ranges::any_of(word, is_digit) ||
         (word.size() % 2 == 0 && std::ranges::all_of(word, is_hex));
}

/// What stands in quotes or in angle brackets: bytes in notation.
std::size_t end_of_bytes(std::string_view text, std::size_t at) {
  const std::size_t end = text.find(text[at] == '<' ? '>' : '\'', at + 1);
  return end == std::string_view::npos ? text.size() : end + 1;
}

}  // namespace

std::string kind_of(const std::string& message) {
  std::string kind;
  const auto add_value = [&kind] {
    if (!kind.ends_with('#') && !kind.ends_with("# ")) kind += '#';
  };
  for (std::size_t at = 0; at < message.size() && kind.size() < longest_kind;) {
    std::size_t end = at;
    while (end < message.size() && is_of_word(message[end])) ++end;
    const std::string_view word = std::string_view(message).substr(at, end - at);
    // Behind a word it is an apostrophe: "the bench's own".
    const bool quoted = message[at] == '\'' && (at == 0 || !is_of_word(message[at - 1]));
    const bool bytes = word.empty() && (quoted || message[at] == '<');
    if (bytes || is_value(word)) {
      if (bytes || !word.empty()) add_value();
      if (bytes) end = end_of_bytes(message, at);
    } else {
      kind += word;
    }
    if (end == at && !(message[end] == ' ' && kind.ends_with(' '))) kind += message[end];
    at = std::max(end, at + 1);
  }
  return kind;
}

std::string to_string(const Finding& finding) {
  return fmt::format("{} case{}: {}{} (first: {})", grouped(finding.cases),
                     finding.cases == 1 ? "" : "s", finding.alike ? "" : "alike, as ",
                     finding.message, fmt::join(finding.first, ", "));
}

const Finding& Failures::add(const results::CaseResult& result) {
  const std::string message = case_message(result);
  std::string kind = fmt::format("{} {}", results::to_string(result.verdict), kind_of(message));
  if (known_.size() >= most_kinds && !known_.contains(kind)) kind = "further kinds";
  auto& [finding, at] = known_[kind];
  if (finding.cases == 0) finding.number = known_.size();
  if (finding.cases++ == 0) finding.message = message;
  finding.alike = finding.alike && finding.message == message;
  if (finding.first.size() < in_full) {
    finding.first.push_back(case_label(result));
    at.push_back(cases_);
  }
  ++cases_;
  return finding;
}

std::vector<const Finding*> Failures::all() const {
  std::vector<const Finding*> all;
  for (const auto& [kind, one] : known_) all.push_back(&one.finding);
  std::ranges::sort(all, std::less<>{}, &Finding::number);
  return all;
}

std::vector<const Finding*> Failures::repeated() const {
  std::vector<const Finding*> again = all();
  std::erase_if(again, [](const Finding* one) { return !one->is_again(); });
  std::ranges::stable_sort(again, std::greater<>{}, &Finding::cases);
  return again;
}

std::vector<std::string> Failures::single() const {
  std::vector<std::pair<std::size_t, std::string>> all;
  for (const auto& [kind, one] : known_)
    for (std::size_t i = 0; !one.finding.is_again() && i < one.at.size(); ++i)
      all.emplace_back(one.at[i], one.finding.first[i]);
  std::ranges::sort(all);
  std::vector<std::string> labels;
  for (auto& [at, label] : all) labels.push_back(std::move(label));
  return labels;
}

}  // namespace fieldproof::text
