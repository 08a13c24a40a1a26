#include "src/base/json_trouble.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace fieldproof {

namespace {

using Words = std::pair<std::string_view, std::string_view>;

constexpr std::string_view end_of_input = "end of input";

/// The library's words for what a text consists of, and ours.
constexpr std::array tokens{Words{end_of_input, "the end of the file"},
                            Words{"string literal", "a text in quotes"},
                            Words{"number literal", "a number"},
                            Words{"true literal", "true"},
                            Words{"false literal", "false"},
                            Words{"null literal", "null"},
                            Words{"'[', '{', or a literal", "a value"}};

std::string in_our_words(std::string_view token) {
  const auto known = std::ranges::find(tokens, token, &Words::first);
  return std::string(known == tokens.end() ? token : known->second);
}

/// Takes what stands before `mark` off `text`, with the mark; empty, and nothing taken, without it.
std::string_view take_before(std::string_view& text, std::string_view mark) {
  const std::size_t at = text.find(mark);
  if (at == text.npos) return {};
  const std::string_view before = text.substr(0, at);
  text.remove_prefix(at + mark.size());
  return before;
}

/// What most often leads to it.
std::string_view cause(std::string_view found, std::string_view due) {
  if (found == end_of_input) return "; is it complete?";
  if (found == "','") return "; is there a comma too many?";
  const bool closes = found == "']'" || found == "'}'";
  if (closes && due != end_of_input) return "; is there a comma too many before it?";
  if (due == "']'" || due == "'}'") return "; is a comma missing before it?";
  return "";
}

/// "syntax error while parsing object key - unexpected '}'; expected string literal".
std::string in_plain_words(std::string_view what) {
  take_before(what, " - ");
  constexpr std::string_view unexpected = "unexpected ";
  if (!what.starts_with(unexpected)) return std::string(what.substr(0, what.find("; expected")));
  what.remove_prefix(unexpected.size());
  const std::string_view found = take_before(what, "; expected "), due = what;
  const bool goes_on = due == "']'" || due == "'}'";
  return (found == end_of_input ? "the file ends" : "there is " + in_our_words(found)) + " where " +
         (goes_on ? "',' or " : "") + in_our_words(due) + " is due" +
         std::string(cause(found, due));
}

}  // namespace

std::string json_trouble(const std::exception& error) {
  std::string_view what = error.what();
  if (!what.starts_with("[json.exception.")) return std::string(what);
  take_before(what, "] ");
  constexpr std::string_view syntax = "parse error at ";
  if (!what.starts_with(syntax)) return std::string(what);
  what.remove_prefix(syntax.size());
  const std::string_view place = take_before(what, ": ");
  return std::string(place) + ": " + in_plain_words(what);
}

}  // namespace fieldproof
