// Ways to break a model of X-NET around the right one: what it is told, where its registers lie,
// what is seen in them. For tables of faults.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <sstream>

#include "suites/xnet/broken/broken_xnet.hpp"

namespace fieldproof::xnet_broken {

using nlohmann::json;
using Make = std::function<Behaviour()>;
using Words = std::vector<std::string>;

// ---- names and texts ----

/// "B:SD2030": "B:", "SD", 2030.
struct Name {
  std::string plc, area;
  long number = -1;
  std::string text() const { return fmt::format("{}{}{}", plc, area, number); }
};
inline Name split(const std::string& text) {
  Name name;
  const std::size_t colon = text.find(':');
  const std::size_t begin = colon == text.npos ? 0 : colon + 1;
  const std::size_t digits = text.find_first_of("0123456789", begin);
  name.plc = text.substr(0, begin);
  if (digits == text.npos) return name;
  name.area = text.substr(begin, digits - begin);
  std::from_chars(text.data() + digits, text.data() + text.size(), name.number);
  return name;
}

inline Words words_of(const std::string& text) {
  std::istringstream in(text);
  Words words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}
inline std::string joined(const Words& words) { return fmt::format("{}", fmt::join(words, " ")); }

/// Which word is the name of the instruction: behind "B:" and "hold".
inline std::size_t head_of(const Words& words) {
  std::size_t at = 0;
  while (at < words.size() && (words[at].ends_with(':') || words[at] == "hold")) ++at;
  return at;
}
inline bool is(const Words& words, const std::string& name) {
  const std::size_t head = head_of(words);
  return head < words.size() && words[head].starts_with(name);
}
inline bool is_number(const std::string& word) {
  return !word.empty() && word.find_first_not_of("-0123456789") == word.npos;
}

// ---- what a device does with what it is told ----

/// Rewrites the words of instructions whose name begins so.
inline Make tells(const std::string& name, void (*change)(Words& words, std::size_t head)) {
  return [=] {
    return Behaviour{.act = [=](const std::string& action, const Look&, const Put&) {
      Words words = words_of(action);
      if (is(words, name)) change(words, head_of(words));
      return words.empty() ? Words{} : Words{joined(words)};
    }};
  };
}
/// Another number behind a keyword.
template <typename Change>
void behind(Words& words, const std::string& keyword, Change change) {
  const auto found = std::ranges::find(words, keyword);
  if (found == words.end() || found + 1 == words.end() || !is_number(found[1])) return;
  found[1] = std::to_string(change(std::stol(found[1])));
}
inline Make ignores(const std::string& ignored) {
  return [=] {
    return Behaviour{.act = [=](const std::string& action, const Look&, const Put&) {
      return action.ends_with(ignored) || is(words_of(action), ignored) ? Words{} : Words{action};
    }};
  };
}

// ---- memory ----

inline long stride(const std::string& area) { return area == "SD" || area == "SFD" ? 60 : 20; }
/// Is it that register of any axis?
inline bool is_of(const Name& name, const Name& first) {
  const long far = name.number - first.number;
  return name.area == first.area && far >= 0 && far % stride(first.area) == 0 &&
         far / stride(first.area) < 20;
}

/// Whatever is set there is not seen.
inline Make deaf(const std::string& reg) {
  return [=] {
    return Behaviour{.set_name = [first = split(reg)](const std::string& text) {
      Name name = split(text);
      if (!is_of(name, first)) return text;
      const bool coil = name.area == "SM";
      name.area = coil ? "HM" : "HD";
      name.number = coil ? 9000 : 20000;
      return name.text();
    }};
  };
}
/// Who sets one sets the other.
inline Make mixed_up(const std::string& one, const std::string& other) {
  return [=] {
    return Behaviour{.set_name = [=, a = split(one), b = split(other)](const std::string& text) {
      Name name = split(text);
      const long far = b.number - a.number;
      if (is_of(name, a))
        name.number += far;
      else if (is_of(name, b))
        name.number -= far;
      else
        return text;
      return name.text();
    }};
  };
}
/// Who looks at one sees the other.
inline Make shows(const std::string& one, const std::string& other) {
  return [=] {
    return Behaviour{.look_name = [=, a = split(one), b = split(other)](const std::string& text) {
      Name name = split(text);
      if (!is_of(name, a)) return text;
      name.number += b.number - a.number;
      return name.text();
    }};
  };
}
/// Registers from `first` to `last` of an area lie `by` further on.
inline Make moved(const std::string& area, long first, long last, long by) {
  return [=] {
    return Behaviour{.look_name = [=](const std::string& text) {
      Name name = split(text);
      if (name.area != area || name.number < first || name.number > last) return text;
      name.number += by;
      return name.text();
    }};
  };
}
/// One value for another, in registers from `first` to `last` of an area.
inline Make sees(const std::string& area, long first, long last, const std::string& from,
                 const std::string& to) {
  return [=] {
    return Behaviour{.value = [=](const std::string& text, const std::string& hex) {
      const Name name = split(text);
      if (name.area != area || name.number < first || name.number > last) return hex;
      if (from.empty()) {
        std::string all;
        while (all.size() < hex.size()) all += to;
        return all.substr(0, hex.size());
      }
      return hex.starts_with(from) ? to + hex.substr(to.size()) : hex;
    }};
  };
}
}  // namespace fieldproof::xnet_broken
