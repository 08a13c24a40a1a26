#include "reports/html/html_time_axis.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace fieldproof::html {

using results::Event;

namespace {

constexpr double cut_from = 2;      // times all frames: a longer silence is cut
constexpr double least_piece = 10;  // so that no two moments are one

}  // namespace

TimeAxis::TimeAxis(const std::vector<const Event*>& events, const results::Due& due, double left,
                   double right)
    : left_(left) {
  std::set<Time> moments;
  for (const Event* event : events) moments.insert({event->start, event->end});
  if (!due.empty()) moments.insert({due.from, due.until});
  for (auto at = moments.begin(); at != moments.end(); ++at)
    if (std::next(at) != moments.end()) pieces_.push_back({*at, *std::next(at)});
  scale_pieces(events);

  double all = 0;
  for (const Piece& one : pieces_) all += one.wide;
  const double room = right - left - least_piece * static_cast<double>(pieces_.size());
  const double scale = all > 0 ? std::max(room, 0.0) / all : 0;
  double at = left;
  if (!pieces_.empty()) x_[pieces_.front().from] = at;
  for (const Piece& one : pieces_) x_[one.to] = at += least_piece + one.wide * scale;
}

void TimeAxis::scale_pieces(const std::vector<const Event*>& events) {
  double busy = 0;
  for (const Event* event : events) busy += to_ms(event->end - event->start);
  const double longest = std::max(cut_from * busy, 0.01);
  for (Piece& one : pieces_) {
    const double took = to_ms(one.to - one.from);
    one.cut = took > longest && std::ranges::none_of(events, [&](const Event* event) {
                return event->start <= one.from && one.to <= event->end;
              });
    // Of two silences that are cut the longer one stays the wider.
    one.wide = one.cut ? longest * (1 + std::log10(took / longest) / 2) : took;
  }
}

double TimeAxis::x(Time moment) const {
  const auto found = x_.find(moment);
  return found == x_.end() ? left_ : found->second;
}

std::vector<double> TimeAxis::cuts() const {
  std::vector<double> middles;
  for (const Piece& one : pieces_)
    if (one.cut) middles.push_back((x(one.from) + x(one.to)) / 2);
  return middles;
}

}  // namespace fieldproof::html
