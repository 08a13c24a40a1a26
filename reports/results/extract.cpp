#include "reports/results/extract.hpp"

#include <algorithm>
#include <iterator>

#include "reports/results/sha256.hpp"

namespace fieldproof::results {

namespace {

bool is_of_run(const Event& event, const Event& first) {
  return event.kind == Event::Kind::received && event.extract.empty() && event.step == first.step &&
         event.surplus == first.surplus && event.link == first.link && event.port == first.port &&
         event.transport == first.transport;
}

/// One event of them all.
Event joined(std::vector<Event>::iterator first, std::vector<Event>::iterator end) {
  Event all = *first;
  for (auto at = std::next(first); at != end; ++at)
    all.bytes.insert(all.bytes.end(), at->bytes.begin(), at->bytes.end());
  all.end = std::prev(end)->end;
  return all;
}

}  // namespace

Extract cut(Bytes& bytes, std::size_t most) {
  if (bytes.size() <= std::max(most, 2 * extract_end)) return {};
  Sha256 sum;
  sum.add(to_text(bytes));
  const auto end = static_cast<std::ptrdiff_t>(extract_end);
  Extract extract{bytes.size(), Bytes(bytes.end() - end, bytes.end()), sum.digits()};
  bytes.resize(extract_end);
  bytes.shrink_to_fit();
  return extract;
}

void cut_runs(std::vector<Event>& exchange, std::size_t most) {
  std::vector<Event> kept;
  for (auto at = exchange.begin(); at != exchange.end();) {
    auto end = at;
    std::size_t count = 0;
    for (; end != exchange.end() && is_of_run(*end, *at); ++end) count += end->bytes.size();
    if (count > most) {
      kept.push_back(joined(at, end));
      kept.back().extract = cut(kept.back().bytes, most);
      at = end;
    } else {
      end = std::max(end, std::next(at));
      std::move(at, end, std::back_inserter(kept));
      at = end;
    }
  }
  exchange = std::move(kept);
}

}  // namespace fieldproof::results
