#include "reports/text/unjudged.hpp"

#include <gmock/gmock.h>

#include "reports/testdata/samples.hpp"

namespace fieldproof::text {
namespace {

using results::Verdict;
using testing::ElementsAre;

std::vector<std::string> lines(const std::vector<std::pair<Verdict, std::string>>& results) {
  Unjudged unjudged;
  for (const auto& [verdict, message] : results)
    unjudged.add(samples::with(verdict, "a/b", message));
  std::vector<std::string> lines;
  for (const UnjudgedReason& one : unjudged.reasons())
    lines.push_back(std::string(results::to_string(one.verdict)) + ' ' + std::to_string(one.cases) +
                    ' ' + one.text);
  return lines;
}

TEST(Unjudged, AReasonIsALineAndBlockedComesFirst) {
  EXPECT_THAT(lines({{Verdict::skip, "excluded by the profile: no such area"},
                     {Verdict::inconclusive, "needs a time of 9.0 ms; below 100 ms"},
                     {Verdict::inconclusive, "needs a time of 5.0 ms; below 100 ms"},
                     {Verdict::blocked, "writes M1; allow it with --allow-write M1"},
                     {Verdict::blocked, "writes D7; allow it with --allow-write D7"}}),
              ElementsAre("BLOCKED 2 permission to write: --allow-write RANGES",
                          "INCONCLUSIVE 2 needs a time of 9.0 ms; below 100 ms",
                          "SKIP 1 excluded by the profile: no such area"));
}

TEST(Unjudged, TheGreatestOfAVerdictComesFirst) {
  EXPECT_THAT(
      lines({{Verdict::skip, "is another protocol"},
             {Verdict::skip, "excluded by the profile: no such area"},
             {Verdict::skip, "excluded by the profile: no such area"}}),
      ElementsAre("SKIP 2 excluded by the profile: no such area", "SKIP 1 is another protocol"));
}

TEST(Unjudged, OtherModelsAreOneReason) {
  EXPECT_THAT(lines({{Verdict::skip, "for xec-h; the profile declares xbc-h"},
                     {Verdict::skip, "for xbm-s, xec-h; the profile declares xbc-h"}}),
              ElementsAre("SKIP 2 for other models; the profile declares xbc-h"));
}

}  // namespace
}  // namespace fieldproof::text
