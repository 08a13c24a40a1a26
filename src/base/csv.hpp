// Fields of comma separated values (RFC 4180).
#pragma once

#include <string>
#include <string_view>

namespace fieldproof {

/// In quotes, its own ones doubled.
inline std::string in_csv_quotes(std::string_view text) {
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? "\"\"" : std::string(1, c);
  return field + '"';
}

}  // namespace fieldproof
