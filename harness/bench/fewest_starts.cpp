#include "harness/bench/fewest_starts.hpp"

#include <algorithm>
#include <map>
#include <tuple>

namespace fieldproof::bench {

namespace {

constexpr const char* as_declared = "{}";

struct Placed {
  const vectors::Case* source;
  std::size_t start, needed;  // the first case that wants it has the least number
  bool fresh;
};

/// The number of each text in the order in which they come.
class Numbers {
 public:
  std::size_t of(const std::string& text) {
    return numbers_.emplace(text, numbers_.size()).first->second;
  }

 private:
  std::map<std::string, std::size_t> numbers_;
};

std::vector<Placed> places_of(const std::vector<const vectors::Case*>& cases,
                              const std::function<SetUpOfCase(const vectors::Case&)>& set_up_of) {
  std::vector<SetUpOfCase> set_ups;
  for (const vectors::Case* one : cases) set_ups.push_back(set_up_of(*one));
  Numbers starts, needs;
  needs.of(as_declared);
  if (const auto first = std::ranges::find(set_ups, as_declared, &SetUpOfCase::needed);
      first != set_ups.end())
    starts.of(first->started_with);
  std::vector<Placed> result;
  for (std::size_t i = 0; i < cases.size(); ++i)
    result.push_back({cases[i], starts.of(set_ups[i].started_with), needs.of(set_ups[i].needed),
                      set_ups[i].fresh});
  return result;
}

}  // namespace

std::vector<const vectors::Case*> fewest_starts(
    const std::vector<const vectors::Case*>& cases,
    const std::function<SetUpOfCase(const vectors::Case&)>& set_up_of) {
  std::vector<Placed> all = places_of(cases, set_up_of);
  const auto by_set_up = [](const Placed& one) { return std::tuple(one.start, one.needed); };
  std::ranges::stable_sort(all, {}, by_set_up);
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find_if(begin, all.end(),
                                  [&](const Placed& one) { return one.start != begin->start; });
    const auto fresh = std::find_if(begin, end, [](const Placed& one) { return one.fresh; });
    if (begin->start > 0 && fresh != end) std::rotate(begin, fresh, fresh + 1);
    begin = end;
  }
  std::vector<const vectors::Case*> sorted;
  for (const Placed& one : all) sorted.push_back(one.source);
  return sorted;
}

}  // namespace fieldproof::bench
