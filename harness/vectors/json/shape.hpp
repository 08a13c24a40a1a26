// What may stand in a JSON document, as a table of keys, types and allowed words.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fieldproof::vectors {

struct Shape;

struct Key {
  std::string_view name;
  const Shape* shape;
  bool required = false;
};

/// How a text is written. `pattern` says the same as `fits` in the words of JSON Schema.
struct Form {
  std::string_view like;  // for messages: "a duration such as 500ms"
  std::string_view pattern;
  bool (*fits)(std::string_view text);
};

/// Where `key` has one of `words`, `then` must be there, too, else `otherwise` must be.
struct Demand {
  std::string_view key;
  std::span<const std::string_view> words;
  std::string_view then, otherwise;
};

/// Tables of constants: all that it points to lives as long as the program.
struct Shape {
  enum class Kind { text, number, boolean, yes, object, list };  // yes: `true` alone
  Kind kind = Kind::text;
  std::size_t least = 0;   // a number; characters of a text, keys of an object, items of a list
  std::size_t most = ~0u;  // likewise
  const Form* form = nullptr;
  std::span<const std::string_view> words{};  // a text is one of these
  bool filled = false;                        // or what a row of `each` gives: "${key}"
  std::span<const Key> keys{};                // of an object
  std::span<const Demand> demands{};
  bool open = false;               // an object may have other keys
  const Shape* others = nullptr;   // their shape; nullptr: any
  const Shape* items = nullptr;    // of a list
  const Shape* instead = nullptr;  // a value of another kind is of this shape
};

/// "${key}", which a row of `each` gives.
bool is_filled(std::string_view text);

/// What is wrong with `value`, one line each: "steps[0]: unknown key 'sned'; did you mean 'send'?".
/// Empty: nothing. A mistyped key is one problem, not two.
std::vector<std::string> shape_problems(const nlohmann::ordered_json& value, const Shape& shape);

}  // namespace fieldproof::vectors
