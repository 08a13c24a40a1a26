#include <algorithm>

#include "harness/judge/judge.hpp"

namespace fieldproof::judging {

using harness::Field;
using results::Difference;

std::vector<Difference> compare_frames(ByteView expected, ByteView received,
                                       const harness::Protocol& protocol, bool requests) {
  std::vector<harness::Field> due = protocol.explain_as(expected, requests);
  std::vector<std::pair<std::size_t, Difference>>
      found;  // with the place in the frame: what comes first, a check follows from
  for (const harness::Field& field : protocol.explain_as(received, requests)) {
    const auto same = std::ranges::find(due, field.name, &harness::Field::name);
    if (same == due.end()) {
      found.push_back({field.offset, {field.name, "nothing", field.text, field.problem}});
      continue;
    }
    if (same->text != field.text)
      found.push_back({std::max(same->offset, field.offset),
                       {field.name, same->text, field.text, field.problem}});
    due.erase(same);
  }
  for (const harness::Field& field : due)
    found.push_back({field.offset, {field.name, field.text, "nothing", ""}});
  std::ranges::stable_sort(found, {}, &std::pair<std::size_t, Difference>::first);
  std::vector<Difference> differences;
  for (auto& [place, difference] : found) differences.push_back(std::move(difference));
  return differences;
}

}  // namespace fieldproof::judging
