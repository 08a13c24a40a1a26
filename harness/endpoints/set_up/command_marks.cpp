#include "harness/endpoints/set_up/command_marks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <span>
#include <vector>

#include "harness/config_keys.hpp"
#include "harness/system/shell_word.hpp"
#include "src/base/spelling.hpp"

namespace fieldproof::endpoints {

namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 4> base_keys{"bit_read_base", "bit_write_base",
                                                    "word_read_base", "word_write_base"};
/// What a command can be told beside the keys of a configuration.
constexpr std::array<std::string_view, 4> marks_of_case{"model", "protocol", "bases", "config"};
/// What the bench fills in itself.
constexpr std::array<std::string_view, 3> own_marks{"tty", "port", "udp_port"};

bool is_one_of(std::span<const std::string_view> words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

bool is_mark_of_case(std::string_view word) {
  return is_one_of(marks_of_case, word) ||
         (harness::is_config_key(word) && !is_one_of(own_marks, word));
}

/// Calls `each` with the place of every `{word}` and the word; `each` returns how many characters
/// of the text to skip.
template <typename Each>
void for_each_word(const std::string& text, const Each& each) {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789_";
  for (std::size_t at = 0; (at = text.find('{', at)) != std::string::npos;) {
    const std::size_t end = text.find_first_not_of(letters, at + 1);
    const bool whole = end != std::string::npos && end > at + 1 && text[end] == '}';
    const bool of_shell = at > 0 && text[at - 1] == '$';
    at += whole && !of_shell ? each(at, text.substr(at + 1, end - at - 1)) : 1;
  }
}

/// Empty where there is none.
std::string value_text(const json& config, const std::string& key) {
  const json value = config.value(key, json());
  return value.is_null() ? "" : plain(value);
}

std::string value_of(const std::string& word, const json& config) {
  if (word == "config") return config.dump();
  if (word != "bases") return value_text(config, word);
  std::vector<std::string> bases;
  for (const std::string_view key : base_keys)
    bases.push_back(value_text(config, std::string(key)));
  return fmt::format("{}", fmt::join(bases, ","));
}

}  // namespace

std::string plain(const json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

Status CommandMarks::check(std::string_view command) {
  std::vector<std::string_view> known(harness::config_keys.begin(), harness::config_keys.end());
  known.insert(known.end(), marks_of_case.begin(), marks_of_case.end());
  known.insert(known.end(), own_marks.begin(), own_marks.end());
  std::string wrong;
  for_each_word(std::string(command), [&](std::size_t, const std::string& word) {
    const bool is_known = is_one_of(known, word);
    if (const std::string near = is_known ? "" : suggestion(word, known);
        wrong.empty() && !near.empty())
      wrong = fmt::format("there is no mark {{{}}}{}", word, near);
    return word.size() + 2;
  });
  return wrong.empty() ? ok() : Status(fail(wrong));
}

bool CommandMarks::takes(std::string_view key) const {
  if (!is_mark_of_case(key)) return false;
  const bool is_base = is_one_of(base_keys, key);
  bool found = false;
  for_each_word(command_, [&](std::size_t, const std::string& word) {
    found = found || word == key || word == "config" || (word == "bases" && is_base);
    return word.size() + 2;
  });
  return found;
}

std::string CommandMarks::filled(const json& config) const {
  std::string text = command_;
  for_each_word(text, [&](std::size_t at, const std::string& word) -> std::size_t {
    if (!is_mark_of_case(word)) return word.size() + 2;
    const std::string value = os::shell_word(value_of(word, config));
    text.replace(at, word.size() + 2, value);
    return value.size();
  });
  return text;
}

}  // namespace fieldproof::endpoints
