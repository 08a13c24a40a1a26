// What holds for every input. A broken rule ends the process, as a sanitizer does.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace fieldproof::fuzz {

inline void rule(bool holds, const char* sentence) {
  if (holds) return;
  std::fprintf(stderr, "broken: %s\n", sentence);
  std::abort();
}

}  // namespace fieldproof::fuzz
