// The fields of a struct named once, for both ways: written as JSON text, and read back.
//
//   void fields(auto& json, Of<Move> auto& move) {
//     json.must("area", move.area);
//     json.may("words", move.words);
//   }
//
// `must`: always written, and has to be there. `always`: always written, may be missing. `may`:
// left out where it is empty, may be missing. A time stands in milliseconds, bytes in hex. Text is
// written straight, without a tree: results are what a long run writes most. Lists of fields keep
// to the order of the alphabet.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "src/base/bytes.hpp"
#include "src/base/time.hpp"

namespace fieldproof::results {

/// T, or const T: `fields` is called with either.
template <typename T, typename U>
concept Of = std::same_as<std::remove_const_t<T>, U>;

/// Words of an enumeration stand as text: `to_string(E)`, and `void from_word(std::string_view,
/// E&)`, which throws by `refuse`.
template <typename T>
concept Word = std::is_enum_v<T>;

/// How reading a foreign shape ends.
[[noreturn]] inline void refuse(const std::string& message) {
  const nlohmann::json none;
  throw nlohmann::json::other_error::create(501, message, &none);
}

class FieldWriter {
 public:
  /// Appends to `out`.
  explicit FieldWriter(std::string& out) : out_(out) {}

  void must(std::string_view key, const auto& value) { member(key, value); }
  void always(std::string_view key, const auto& value) { member(key, value); }
  template <typename T>
  void may(std::string_view key, const T& value, const T& usual = {}) {
    if constexpr (requires { value.empty(); }) {
      if (!value.empty()) member(key, value);
    } else if (value != usual) {
      member(key, value);
    }
  }
  /// Follows from other fields: told to readers, never read.
  void derived(std::string_view key, const auto& value) { member(key, value); }
  void otherwise(std::string_view, const auto&, const auto&) {}

  template <typename T>
  void value(const T& one) {
    if constexpr (std::convertible_to<const T&, std::string_view>)
      text(one);
    else if constexpr (Word<T>)
      text(to_string(one));
    else if constexpr (std::same_as<T, Bytes>)
      text(to_hex(one));
    else if constexpr (std::same_as<T, bool>)
      out_ += one ? "true" : "false";
    else if constexpr (std::integral<T>)
      fmt::format_to(std::back_inserter(out_), "{}", one);
    else if constexpr (std::same_as<T, double>)
      number(one);
    else if constexpr (std::same_as<T, Duration>)
      time(one);
    else if constexpr (requires { typename T::mapped_type; })
      object(one);
    else if constexpr (requires { one.begin(); })
      list('[', one, ']', [this](const auto& element) { value(element); });
    else if constexpr (requires { one.second; })
      list('[', std::array{&one.first, &one.second}, ']', [this](auto* half) { value(*half); });
    else
      structure(one);
  }

 private:
  void member(std::string_view key, const auto& one) {
    out_ += std::exchange(first_, false) ? "\"" : ",\"";
    out_ += key;
    out_ += "\":";
    value(one);
  }

  void structure(const auto& one) {
    out_ += '{';
    const bool outer = std::exchange(first_, true);
    fields(*this, one);
    first_ = outer;
    out_ += '}';
  }

  void list(char open, const auto& elements, char close, const auto& write) {
    out_ += open;
    bool first = true;
    for (const auto& one : elements) {
      if (!std::exchange(first, false)) out_ += ',';
      write(one);
    }
    out_ += close;
  }

  void object(const auto& map) {
    list('{', map, '}', [this](const auto& entry) {
      text(entry.first);
      out_ += ':';
      value(entry.second);
    });
  }

  void text(std::string_view characters) {
    const auto plain = [](unsigned char c) {
      return c >= 0x20 && c < 0x80 && c != '"' && c != '\\';
    };
    if (std::ranges::all_of(characters, plain)) {
      out_ += '"';
      out_ += characters;
      out_ += '"';
    } else {  // escapes, and U+FFFD for what is not UTF-8
      using nlohmann::json;
      out_ += json(characters).dump(-1, ' ', false, json::error_handler_t::replace);
    }
  }

  void number(double one) {
    if (!std::isfinite(one)) {
      out_ += "null";  // JSON knows no other
      return;
    }
    const std::size_t start = out_.size();
    fmt::format_to(std::back_inserter(out_), "{}", one);
    if (out_.find_first_of(".e", start) == std::string::npos) out_ += ".0";
  }

  /// Milliseconds to the nanosecond: exact, and a tenth of the work of a double.
  void time(Duration one) {
    constexpr std::int64_t ns_per_ms = 1'000'000;
    const std::uint64_t ns = one.count() < 0 ? -static_cast<std::uint64_t>(one.count())
                                             : static_cast<std::uint64_t>(one.count());
    if (one.count() < 0) out_ += '-';
    const fmt::format_int whole(ns / ns_per_ms);
    out_.append(whole.data(), whole.size());
    std::array<char, 7> rest{'.', '0', '0', '0', '0', '0', '0'};
    std::size_t length = 2;  // ".0" at least
    std::uint64_t left = ns % ns_per_ms;
    for (std::size_t i = rest.size() - 1; left > 0; --i, left /= 10) {
      rest[i] = static_cast<char>('0' + left % 10);
      if (rest[i] != '0') length = std::max(length, i + 1);
    }
    out_.append(rest.data(), length);
  }

  std::string& out_;
  bool first_ = true;  // of the object being written
};

class FieldReader {
 public:
  explicit FieldReader(const nlohmann::json& object) : object_(object) {}

  void must(const char* key, auto& value) { read(object_.at(key), value, key); }
  void always(const char* key, auto& value) {
    if (const auto found = object_.find(key); found != object_.end()) read(*found, value, key);
  }
  template <typename T>
  void may(const char* key, T& value, const T& = {}) {
    always(key, value);
  }
  void derived(const char*, const auto&) {}
  /// A field of older files that came from another one.
  void otherwise(const char* key, auto& value, const auto& other) {
    if (!object_.contains(key)) value = other;
  }

 private:
  template <typename T>
  static void read(const nlohmann::json& json, T& value, const char* key) {
    if constexpr (std::same_as<T, Bytes>)
      read_bytes(json, value, key);
    else if constexpr (std::same_as<T, Duration>)
      read_time(json, value, key);
    else if constexpr (Word<T>)
      from_word(json.get<std::string>(), value);
    else
      json.get_to(value);
  }

  static void read_bytes(const nlohmann::json& json, Bytes& bytes, const char* key) {
    std::optional<Bytes> parsed = from_hex(json.get<std::string>());
    if (!parsed) refuse(fmt::format("'{}' is not hex", key));
    bytes = std::move(*parsed);
  }

  static void read_time(const nlohmann::json& json, Duration& time, const char* key) {
    const double ms = json.get<double>();
    if (!(std::abs(ms) < 9e12)) refuse(fmt::format("'{}' is not a time of a run", key));
    time = from_ms(ms);
  }

  const nlohmann::json& object_;
};

template <typename T>
void read_fields(const nlohmann::json& json, T& value) {
  value = {};
  FieldReader reader(json);
  fields(reader, value);
}

/// For nlohmann's get and get_to: all that has a list of fields.
template <typename T>
requires requires(FieldReader& reader, T& value) { fields(reader, value); }
void from_json(const nlohmann::json& json, T& value) { read_fields(json, value); }

}  // namespace fieldproof::results
