// ASCII letters, whatever the locale is.
#pragma once

#include <string>

namespace fieldproof {

constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string upper(std::string text) {
  for (char& c : text) c = upper(c);
  return text;
}

}  // namespace fieldproof
