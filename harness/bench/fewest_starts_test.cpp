#include "harness/bench/fewest_starts.hpp"

#include <gmock/gmock.h>

#include <map>

namespace fieldproof::bench {
namespace {

using testing::ElementsAre;
using vectors::Case;

/// The ids of the cases in the order in which they are run.
std::vector<std::string> order_of(const std::vector<std::pair<std::string, SetUpOfCase>>& wanted) {
  std::vector<Case> cases(wanted.size());
  std::map<std::string, SetUpOfCase> set_ups(wanted.begin(), wanted.end());
  std::vector<const Case*> all;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    cases[i].id = wanted[i].first;
    all.push_back(&cases[i]);
  }
  std::vector<std::string> ids;
  for (const Case* one :
       fewest_starts(all, [&](const Case& source) { return set_ups.at(source.id); }))
    ids.push_back(one->id);
  return ids;
}

TEST(FewestStarts, CasesOfOneStartAreTogetherAndElseInTheirOrder) {
  EXPECT_THAT(order_of({{"a/1", {"plc 2", R"({"station":2})"}},
                        {"a/2", {"plc 1", "{}"}},
                        {"b/1", {"plc 2", R"({"station":2})"}},
                        {"b/2", {"plc 3", R"({"station":3})"}},
                        {"c/1", {"plc 1", "{}"}},
                        {"c/2", {"plc 2", R"({"station":2})"}}}),
              ElementsAre("a/2", "c/1", "a/1", "b/1", "c/2", "b/2"))
      << "those of the declared device first";
}

TEST(FewestStarts, WhatIsToldIsTogetherWithinAStart) {
  EXPECT_THAT(order_of({{"1", {"plc 1", "{}"}},
                        {"2", {"plc 1", R"({"delay_ms":10})"}},
                        {"3", {"plc 2", R"({"delay_ms":10,"station":2})"}},
                        {"4", {"plc 1", "{}"}},
                        {"5", {"plc 1", R"({"delay_ms":10})"}}}),
              ElementsAre("1", "4", "2", "5", "3"));
}

TEST(FewestStarts, AFreshDeviceIsThereBehindAStart) {
  EXPECT_THAT(order_of({{"1", {"plc 1", "{}"}},
                        {"2", {"plc 1", "{}", true}},
                        {"3", {"plc 2", R"({"station":2})"}},
                        {"4", {"plc 2", R"({"station":2})", true}},
                        {"5", {"plc 2", R"({"station":2})", true}}}),
              ElementsAre("1", "2", "4", "3", "5"))
      << "but the opening exchange has asked the first";
}

}  // namespace
}  // namespace fieldproof::bench
