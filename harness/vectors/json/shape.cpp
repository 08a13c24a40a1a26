#include "harness/vectors/json/shape.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "src/base/spelling.hpp"

namespace fieldproof::vectors {

namespace {

using json = nlohmann::ordered_json;
using ShapeKind = Shape::Kind;

/// Where a value stands; made on the stack, spelled only for a problem.
struct Path {
  const Path* up = nullptr;
  std::string_view key;
  std::size_t index = 0;

  std::string text() const {
    if (!up) return {};
    const std::string before = up->text();
    if (key.empty()) return fmt::format("{}[{}]", before, index);
    return before.empty() ? std::string(key) : fmt::format("{}.{}", before, key);
  }
};

std::string_view name_of(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::text: return "a text";
    case ShapeKind::number: return "a whole number";
    case ShapeKind::boolean: return "true or false";
    case ShapeKind::yes: return "true";
    case ShapeKind::object: return "an object";
    case ShapeKind::list: return "a list";
  }
  return "";
}

bool is_of(ShapeKind kind, const json& value) {
  switch (kind) {
    case ShapeKind::text: return value.is_string();
    case ShapeKind::number: return value.is_number_integer();
    case ShapeKind::boolean: return value.is_boolean();
    case ShapeKind::yes: return value.is_boolean() && value.get<bool>();
    case ShapeKind::object: return value.is_object();
    case ShapeKind::list: return value.is_array();
  }
  return false;
}

/// As much of the value as a message needs.
std::string shown(const json& value) {
  if (value.is_object()) return "an object";
  if (value.is_array()) return "a list";
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() <= 60 ? text : fmt::format("{:.57}...", text);
}

class Checker {
 public:
  void check(const json& value, const Shape& shape, const Path& path) {
    if (!is_of(shape.kind, value)) {
      if (shape.instead) return check(value, *shape.instead, path);
      return problem(path, fmt::format("is {}; write {}", shown(value), name_of(shape.kind)));
    }
    switch (shape.kind) {
      case ShapeKind::text: return check_text(value.get_ref<const std::string&>(), shape, path);
      case ShapeKind::number: return check_number(value.get<std::int64_t>(), shape, path);
      case ShapeKind::object: return check_object(value, shape, path);
      case ShapeKind::list: return check_list(value, shape, path);
      case ShapeKind::boolean:
      case ShapeKind::yes: return;
    }
  }

  std::vector<std::string> take() { return std::move(problems_); }

 private:
  void problem(const Path& path, std::string_view what) {
    const std::string at = path.text();
    problems_.push_back(fmt::format("{}{}{}", at, at.empty() ? "" : ": ", what));
  }

  void check_size(std::size_t size, const Shape& shape, std::string_view unit, const Path& path) {
    if (size < shape.least)
      problem(path, fmt::format("has {} {}; it needs at least {}", size, unit, shape.least));
    if (size > shape.most)
      problem(path, fmt::format("has {} {}; it may have {}", size, unit, shape.most));
  }

  void check_text(const std::string& text, const Shape& shape, const Path& path) {
    check_size(text.size(), shape, "characters", path);
    if (shape.filled && is_filled(text)) return;
    if (!shape.words.empty() && std::ranges::find(shape.words, text) == shape.words.end())
      problem(path, fmt::format("'{}' is none of {}{}", text, fmt::join(shape.words, ", "),
                                suggestion(text, shape.words)));
    if (shape.form && !shape.form->fits(text))
      problem(path, fmt::format("'{}' is not {}", text, shape.form->like));
  }

  void check_number(std::int64_t number, const Shape& shape, const Path& path) {
    if (number < static_cast<std::int64_t>(shape.least) ||
        number > static_cast<std::int64_t>(shape.most))
      problem(path, shape.most == ~0u
                        ? fmt::format("is {}; write {} or more", number, shape.least)
                        : fmt::format("is {}; write {} to {}", number, shape.least, shape.most));
  }

  void check_list(const json& list, const Shape& shape, const Path& path) {
    check_size(list.size(), shape, "items", path);
    for (std::size_t i = 0; i < list.size() && shape.items; ++i)
      check(list[i], *shape.items, Path{&path, "", i});
  }

  void check_object(const json& object, const Shape& shape, const Path& path) {
    check_size(object.size(), shape, "keys", path);
    std::vector<std::string_view> meant;
    for (const auto& [key, value] : object.items()) {
      const auto known = std::ranges::find(shape.keys, key, &Key::name);
      if (known != shape.keys.end())
        check(value, *known->shape, Path{&path, key});
      else if (!shape.open)
        unknown_key(key, object, shape, path, meant);
      else if (shape.others)
        check(value, *shape.others, Path{&path, key});
    }
    const auto demand = [&](std::string_view key) {
      if (!object.contains(key) && std::ranges::find(meant, key) == meant.end())
        problem(path, fmt::format("lacks '{}'", key));
    };
    for (const Key& key : shape.keys)
      if (key.required) demand(key.name);
    for (const Demand& one : shape.demands) {
      const bool holds =
          object.contains(one.key) && object[one.key].is_string() &&
          std::ranges::count(one.words, object[one.key].get_ref<const std::string&>());
      if (const std::string_view key = holds ? one.then : one.otherwise; !key.empty()) demand(key);
    }
  }

  /// `meant` takes the absent key that it is a slip of.
  void unknown_key(const std::string& key, const json& object, const Shape& shape, const Path& path,
                   std::vector<std::string_view>& meant) {
    std::vector<std::string_view> absent, all;
    for (const Key& known : shape.keys) {
      all.push_back(known.name);
      if (!object.contains(known.name)) absent.push_back(known.name);
    }
    std::string hint = suggestion(key, absent);
    for (const std::string_view name : absent)
      if (hint.find(fmt::format("'{}'", name)) != std::string::npos) meant.push_back(name);
    if (hint.empty()) hint = fmt::format("; there are {}", fmt::join(all, ", "));
    problem(path, fmt::format("unknown key '{}'{}", key, hint));
  }

  std::vector<std::string> problems_;
};

}  // namespace

bool is_filled(std::string_view text) {
  constexpr std::string_view characters = "abcdefghijklmnopqrstuvwxyz0123456789_";
  return text.size() > 3 && text.starts_with("${") &&
         text.find_first_not_of(characters, 2) == text.size() - 1 && text.back() == '}';
}

std::vector<std::string> shape_problems(const json& value, const Shape& shape) {
  Checker checker;
  checker.check(value, shape, Path{});
  return checker.take();
}

}  // namespace fieldproof::vectors
