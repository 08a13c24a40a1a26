// What happens to the tool in the middle of a run, at a chosen moment.
#pragma once

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

namespace fieldproof::tool_tests {

/// Makes something happen in the tool at its N-th call that changes a file (moments/moments.cpp).
inline std::vector<std::pair<std::string, std::string>> at_moment(int moment,
                                                                  const std::string& act) {
  const char* const asan = std::getenv("ASAN_OPTIONS");  // which wants to be loaded first
  return {{"LD_PRELOAD", FIELDPROOF_MOMENTS},
          {"ASAN_OPTIONS", (asan ? std::string(asan) + ':' : "") + "verify_asan_link_order=0"},
          {"MOMENT", std::to_string(moment)},
          {"ACT", act}};
}

}  // namespace fieldproof::tool_tests
