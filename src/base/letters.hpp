// ASCII letters, whatever the locale is.
#pragma once

#include <string>

namespace fieldproof {

constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

constexpr char upper(char c) { return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string upper(std::string text) {
  for (char& c : text) c = upper(c);
  return text;
}

}  // namespace fieldproof
