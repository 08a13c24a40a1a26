#include "reports/history/flaky.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include <cstdint>

namespace fieldproof::history {

using results::Verdict;
using text::Tally;

namespace {

/// Runs that should have come out alike.
using Group = std::vector<const RunEntry*>;

/// A waiver changes the word, not what the device did.
Verdict bare(Verdict verdict) {
  return verdict == Verdict::xfail   ? Verdict::fail
         : verdict == Verdict::xpass ? Verdict::pass
                                     : verdict;
}

std::size_t most_common(const Tally& bare_verdicts) {
  std::size_t most = 0;
  for (const Verdict one : Tally::verdicts) most = std::max(most, bare_verdicts.of(one));
  return most;
}

/// What came of each case in the runs of a group.
class Census {
 public:
  explicit Census(History& history) : history_(history) {}

  Status count(const Group& group) {
    std::map<std::int64_t, Group> selections;  // by the list of their cases
    for (const RunEntry* run : group) selections[run->cases].push_back(run);
    const bool all_alike =
        selections.size() == 1 && std::ranges::all_of(group, [&](const RunEntry* run) {
          return run->verdicts == group.front()->verdicts && run->repetitions == run->with_verdict;
        });
    if (all_alike) return ok();
    for (const auto& [cases, runs] : selections) {
      const Result<Numbers> ids = ids_of(*runs.front());
      if (!ids) return ids.error();
      if (const Status counted = count_verdicts(*ids, runs); !counted) return counted;
      for (const RunEntry* run : runs)
        if (run->repetitions != run->with_verdict)
          if (const Status counted = count_within(*ids, *run); !counted) return counted;
    }
    return ok();
  }

  Result<std::vector<FlakyCase>> take(const RunEntry& like) {
    Numbers ids;
    std::vector<FlakyCase> found;
    for (std::size_t id = 0; id < cases_.size(); ++id) {
      const Row& row = cases_[id];
      const std::size_t odd = row.bare.total() - most_common(row.bare);
      if (odd == 0 && row.within == 0) continue;
      ids.push_back(static_cast<std::int64_t>(id));
      found.push_back({"", like.device, like.firmware, like.vectors, row.verdicts, row.within,
                       odd > 0 ? last_odd(row) : 0});
    }
    const Result<std::vector<CaseFacts>> facts = history_.cases(ids);
    if (!facts) return facts.error();
    for (std::size_t i = 0; i < found.size(); ++i) found[i].name = (*facts)[i].name;
    return found;
  }

 private:
  struct Row {
    Tally verdicts, bare;
    std::array<std::int64_t, Tally::verdicts.size()> last{};  // run, by bare verdict
    std::size_t within = 0;
  };

  static std::int64_t last_odd(const Row& row) {
    const std::size_t most = most_common(row.bare);
    const auto usual =
        std::ranges::find(Tally::verdicts, most, [&](Verdict one) { return row.bare.of(one); });
    std::int64_t last = 0;
    for (const Verdict one : Tally::verdicts)
      if (one != *usual) last = std::max(last, row.last[static_cast<std::size_t>(one)]);
    return last;
  }

  Result<Numbers> ids_of(const RunEntry& run) {
    Result<Numbers> steps = history_.list(run.cases);
    if (!steps) return steps.error();
    Numbers ids = from_steps(std::move(*steps));
    if (const auto greatest = std::ranges::max_element(ids);
        greatest != ids.end() && *greatest >= std::ssize(cases_))
      cases_.resize(static_cast<std::size_t>(*greatest) + 1);
    return ids;
  }

  /// Most runs of a selection come out alike: what differs from the last of them is counted, the
  /// rest follows.
  Status count_verdicts(const Numbers& ids, const Group& runs) {
    std::map<std::int64_t, Group> alike;  // by the list of their verdicts
    for (const RunEntry* run : runs) alike[run->verdicts].push_back(run);
    const RunEntry& last = *std::ranges::max(runs, {}, &RunEntry::number);
    const Result<Numbers> usual = history_.list(last.verdicts);
    if (!usual) return usual.error();
    const std::vector<std::int8_t> codes(usual->begin(), usual->end());
    std::vector<std::size_t> left(codes.size(), runs.size());
    for (const auto& [list, same] : alike) {
      if (list == last.verdicts) continue;
      const Result<std::vector<Repeated>> parts = history_.repeated(list);
      if (!parts) return parts.error();
      const std::int64_t number = std::ranges::max(same, {}, &RunEntry::number)->number;
      each_difference(codes, *parts, [&](std::size_t i, std::int64_t code) {
        left[i] -= same.size();
        add(ids, i, code, same.size(), number);
      });
    }
    for (std::size_t i = 0; i < codes.size(); ++i) add(ids, i, codes[i], left[i], last.number);
    return ok();
  }

  static void each_difference(const std::vector<std::int8_t>& codes,
                              const std::vector<Repeated>& parts, const auto& visit) {
    auto first = codes.begin();
    for (const Repeated& part : parts) {
      const auto end = first + std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(part.count),
                                                        codes.end() - first);
      const auto code = static_cast<std::int8_t>(part.number);
      if (std::count(first, end, code) != end - first)
        for (auto at = first; at != end; ++at)
          if (*at != code) visit(static_cast<std::size_t>(at - codes.begin()), part.number);
      first = end;
    }
  }

  void add(const Numbers& ids, std::size_t i, std::int64_t code, std::size_t runs,
           std::int64_t number) {
    const std::optional<Verdict> verdict = verdict_of(code);
    if (runs == 0 || i >= ids.size() || !verdict || !results::is_judged(*verdict)) return;
    Row& row = cases_[static_cast<std::size_t>(ids[i])];
    row.verdicts.add(*verdict, runs);
    row.bare.add(bare(*verdict), runs);
    std::int64_t& seen = row.last[static_cast<std::size_t>(bare(*verdict))];
    seen = std::max(seen, number);
  }

  Status count_within(const Numbers& ids, const RunEntry& run) {
    const Result<Numbers> all = history_.list(run.repetitions),
                          alike = history_.list(run.with_verdict);
    for (const auto* list : {&all, &alike})
      if (!*list) return list->error();
    for (std::size_t i = 0; i < std::min({ids.size(), all->size(), alike->size()}); ++i)
      if ((*alike)[i] < (*all)[i]) ++cases_[static_cast<std::size_t>(ids[i])].within;
    return ok();
  }

  History& history_;
  std::vector<Row> cases_;  // by id
};

}  // namespace

Result<std::vector<FlakyCase>> flaky_cases(History& history, const std::vector<RunEntry>& runs) {
  std::map<std::tuple<std::string, std::string, std::string>, Group> groups;
  for (const RunEntry& run : runs) groups[{run.device, run.firmware, run.vectors}].push_back(&run);
  std::vector<FlakyCase> all;
  for (const auto& [key, group] : groups) {
    Census census(history);
    if (const Status counted = census.count(group); !counted) return counted.error();
    Result<std::vector<FlakyCase>> found = census.take(*group.front());
    if (!found) return found.error();
    std::ranges::move(*found, std::back_inserter(all));
  }
  const auto odd = [](const FlakyCase& one) {
    return one.verdicts.total() - most_common(one.verdicts) + one.within;
  };
  std::ranges::stable_sort(all, std::ranges::greater(), odd);
  return all;
}

std::string flaky_text(const FlakyCase& one) {
  const std::size_t runs = one.verdicts.total();
  std::string text;
  for (const Verdict verdict : Tally::verdicts)
    if (const std::size_t count = one.verdicts.of(verdict))
      text +=
          fmt::format("{}{} in {}", text.empty() ? "" : ", ", results::to_string(verdict), count);
  text += fmt::format(" of {} {}", runs, runs == 1 ? "run" : "runs");
  if (one.within > 0) text += fmt::format("; repetitions differ within {} of them", one.within);
  if (one.last_odd > 0) text += fmt::format("; the last odd one is run {}", one.last_odd);
  return text;
}

}  // namespace fieldproof::history
