#include "src/plc/config_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"

namespace fieldproof::plc {

namespace {
using nlohmann::json;

std::string joined(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text;
}

std::string text_of(const json& value) {
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<double> number_in(const std::string& text) {
  double n = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(n))
    return std::nullopt;
  return n;
}

bool is_name_of_host(std::string_view text) {
  const auto is_part_of_name = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '.' || c == '_';
  };
  const std::string_view last = text.substr(text.rfind('.') + 1);
  return !last.empty() && std::ranges::all_of(text, is_part_of_name) &&
         last.find_first_not_of("0123456789") != last.npos;  // else it is a wrong address
}
}  // namespace

bool is_ipv4(std::string_view text) {
  unsigned parts = 0;
  for (; parts < 4; ++parts) {
    const std::size_t end = std::min(text.find('.'), text.size());
    const std::string_view part = text.substr(0, end);
    unsigned value = 0;
    const auto [rest, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    const bool whole = error == std::errc{} && rest == part.data() + part.size();
    if (!whole || value > 255 || part.size() != std::to_string(value).size()) return false;
    if (end == text.size()) return parts == 3;
    text.remove_prefix(end + 1);
  }
  return false;
}

Status known_keys(const json& object, std::string_view what,
                  std::span<const std::string_view> keys) {
  if (!object.is_object())
    return fail(fmt::format("cannot read {}: it is not a JSON object", what));
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(keys, key) != keys.end()) continue;
    return fail(fmt::format("cannot read {}: there is no key '{}'; the keys are {}{}", what, key,
                            joined(keys), suggestion(key, keys)));
  }
  return ok();
}

void ConfigReader::number(const char* key, double least, double most,
                          const std::function<void(double)>& take) {
  const json* value = find(key);
  if (!value) return;
  const std::optional<double> n =
      value->is_number() ? std::optional(value->get<double>()) : number_in(text_of(*value));
  if (!n || *n < least || *n > most)
    return wrong(key, *value, fmt::format("a number from {} to {}", least, most));
  take(*n);
}

void ConfigReader::whole(const char* key, unsigned most, unsigned& to, unsigned least) {
  number(key, least, most, [&](double n) {
    if (n != std::floor(n))
      wrong(key, object_[key], "a whole number");
    else
      to = static_cast<unsigned>(n);
  });
}

void ConfigReader::milliseconds(const char* key, Duration& to) {
  constexpr double longest = 60'000;
  number(key, 0, longest, [&](double n) { to = from_ms(n); });
}

void ConfigReader::boolean(const char* key, bool& to) {
  const json* value = find(key);
  if (!value) return;
  const std::string text = value->is_string() ? value->get<std::string>() : value->dump();
  if (text == "true" || text == "1")
    to = true;
  else if (text == "false" || text == "0")
    to = false;
  else
    wrong(key, *value, "true or false");
}

void ConfigReader::text(const char* key, std::string& to) {
  const json* value = find(key);
  if (!value) return;
  if (value->is_string())
    to = value->get<std::string>();
  else
    wrong(key, *value, "a text");
}

void ConfigReader::host(const char* key, std::string& to) {
  const json* value = find(key);
  if (!value) return;
  const std::string host = text_of(*value);
  if (is_ipv4(host) || is_name_of_host(host))
    to = host;
  else
    wrong(key, *value, "an IPv4 address such as \"192.0.2.1\", or the name of a host");
}

void ConfigReader::either(const char* key, std::string_view yes, std::string_view no, bool& to) {
  std::string word(to ? yes : no);
  text(key, word);
  if (error_) return;
  if (word == yes || word == no)
    to = word == yes;
  else
    error_ = fail(fmt::format("cannot read {}: {} is '{}', which is not {} or {}", what_, key, word,
                              yes, no));
}

void ConfigReader::line(const char* key, line::LineSettings& to) {
  std::string settings = line::to_string(to);
  text(key, settings);
  if (error_) return;
  const Result<line::LineSettings> parsed = line::parse_line_settings(settings);
  if (parsed)
    to = *parsed;
  else
    error_ = parsed.error();
}

void ConfigReader::wrong(const std::string& key, const json& value, const std::string& expected) {
  if (error_) return;
  const std::string given = value.dump(-1, ' ', true, json::error_handler_t::replace);
  error_ =
      fail(fmt::format("cannot read {}: {} is {}, which is not {}", what_, key, given, expected));
}

const json* ConfigReader::find(const char* key) const {
  const auto found = object_.find(key);
  return error_ || found == object_.end() ? nullptr : &*found;
}

}  // namespace fieldproof::plc
