#include "reports/html/html_trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "reports/text/tally.hpp"

namespace fieldproof::html {

namespace {

using Sample = AxisTrace::Sample;

// In units of the picture; text has the size that the style sheet gives it.
constexpr double picture_width = 640, plot_left = 62, plot_right = 632, numbers_base = 30;
constexpr double label_room = 46;  // between numbers of marks
constexpr std::size_t colours = 6, most_listed = 40, most_drawn = 100;
constexpr double finest_drawn = 5e-3;  // of the range: a unit

/// Values along one side of a plot.
struct Side {
  double from = 0, to = 1;      // values
  double begin = 0, end = 100;  // units

  double at(double value) const { return begin + (end - begin) * (value - from) / (to - from); }
  bool has(double value) const { return value >= from && value <= to; }
};

/// Of values that are there, with room at both ends.
class Span {
 public:
  void add(double value) {
    least_ = std::min(least_, value);
    greatest_ = std::max(greatest_, value);
  }
  double length() const { return greatest_ - least_; }
  double least() const { return least_; }
  double greatest() const { return greatest_; }
  Side side(double begin, double end) const {
    const double room = length() > 0 ? length() * 0.06 : 1;
    return {least_ - room, greatest_ + room, begin, end};
  }

 private:
  double least_ = std::numeric_limits<double>::max();
  double greatest_ = std::numeric_limits<double>::lowest();
};

/// 1, 2 or 5 of a power of ten apart.
std::vector<double> ticks(const Side& side, double count) {
  const double raw = (side.to - side.from) / count;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  const double step = raw <= 2 * power ? 2 * power : raw <= 5 * power ? 5 * power : 10 * power;
  std::vector<double> found;
  for (double at = std::ceil(side.from / step); at * step <= side.to && found.size() < 20; ++at)
    found.push_back(at * step + 0.0);
  return found;
}

/// As short as it can be: a run has hundreds of pictures.
std::string units(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// 500, 41k, 2.5M
std::string brief(double value) {
  if (std::abs(value) >= 1e6) return fmt::format("{:.4g}M", value / 1e6);
  if (std::abs(value) >= 1e4) return fmt::format("{:.4g}k", value / 1e3);
  return fmt::format("{:.4g}", value);
}

/// In a row: x, and the text.
using Labels = std::vector<std::pair<double, std::string>>;

void write_row(HtmlWriter& out, double y, const Labels& labels) {
  out.element("text", {{"class", "x"}, {"y", units(y)}}, [&] {
    for (const auto& [x, what] : labels) out.element("tspan", {{"x", units(std::round(x))}}, what);
  });
}

/// Labels left of a plot, each with its y.
void write_steps(HtmlWriter& out, const auto& body) {
  const std::string place = fmt::format("translate({} 4)", plot_left - 6);
  out.element("g", {{"class", "y"}, {"transform", place}}, body);
}

void write_picture(HtmlWriter& out, double tall, const std::string& what, const auto& body) {
  out.picture(fmt::format("{} {}", picture_width, units(tall)), what, body);
}

/// Ticks along the bottom, with the unit at the last.
void write_times(HtmlWriter& out, const Side& time, double top, double bottom) {
  const double scale = time.to - time.from >= 20'000 ? 1e-3 : 1;  // seconds
  const std::vector<double> found = ticks({time.from * scale, time.to * scale}, 4);
  const char* const unit = scale < 1 ? " s" : " ms";
  std::string path;
  Labels labels;
  for (const double at : found) {
    const double x = std::round(time.at(at / scale));
    path += fmt::format("M{} {}V{}", units(x), units(top), units(bottom));
    labels.emplace_back(x, fmt::format("{:g}{}", at, at == found.back() ? unit : ""));
  }
  out.empty("path", {{"class", "grid"}, {"d", path}});
  write_row(out, bottom + 17, labels);
}

// ---- axes ----

/// What happened to one of the axes, in the order of time of all.
struct Mark {
  double ms = 0;
  std::string what;
};

class Motion {
 public:
  Motion(HtmlWriter& out, const std::vector<AxisTrace>& axes, Time zero)
      : out_(out), axes_(axes), zero_(zero) {
    gather_marks();
    Span times, positions, speeds;
    speeds.add(0);
    for (const AxisTrace& one : axes) add(one, times, positions, speeds);
    for (const Mark& one : marks_) times.add(one.ms);
    add_limits_in_reach(positions);
    time_ = {times.least(), std::max(times.greatest(), times.least() + 1), plot_left, plot_right};
    position_ = positions.side(192, 38);
    speed_ = speeds.side(322, 228);
  }

  void write() {
    out_.element("figure", {{"class", "trace"}}, [&] {
      write_picture(out_, 346, "motion", [&] {
        write_times(out_, time_, position_.end, speed_.begin);
        write_side(position_, 3, "position, pulses");
        write_side(speed_, 2.5, "speed, pulses/s");
        write_limits();
        write_marks();
        write_lines(position_, &Sample::position);
        write_lines(speed_, &Sample::speed);
      });
      write_caption();
    });
  }

 private:
  double ms(Time time) const { return to_ms(time - zero_); }
  std::string name(const AxisTrace& axis) const { return "axis " + axis.axis; }
  std::string colour(const AxisTrace& axis) const {
    return fmt::format("a{}", static_cast<std::size_t>(&axis - axes_.data()) % colours);
  }

  void gather_marks() {
    for (const AxisTrace& axis : axes_)
      for (const AxisTrace::Event& event : axis.events)
        marks_.push_back(
            {ms(event.time), axes_.size() > 1 ? name(axis) + ": " + event.what : event.what});
    std::ranges::stable_sort(marks_, {}, &Mark::ms);
  }

  /// All but the time in which it stood before and after.
  void add(const AxisTrace& axis, Span& times, Span& positions, Span& speeds) {
    const std::vector<Sample>& all = axis.samples;
    if (all.size() == 1) times.add(ms(all.front().time));
    for (const Sample& one : all) {
      positions.add(one.position);
      speeds.add(one.speed);
    }
    const auto stands = [](const Sample& a, const Sample& b) {
      return a.position == b.position && a.speed == 0 && b.speed == 0;
    };
    for (std::size_t i = 0; i + 1 < all.size(); ++i)
      if (!stands(all[i], all[i + 1])) {
        times.add(ms(all[i].time));
        times.add(ms(all[i + 1].time));
      }
  }

  void add_limits_in_reach(Span& positions) {
    const double reach = positions.length();
    const double least = positions.least() - reach, greatest = positions.greatest() + reach;
    for (const AxisTrace& axis : axes_)
      for (const AxisTrace::Limit& limit : axis.limits)
        for (const double at : {limit.from, limit.to})
          if (at >= least && at <= greatest) positions.add(at);
  }

  void write_side(const Side& side, double count, std::string_view title) {
    std::string path;
    write_steps(out_, [&] {
      for (const double at : ticks(side, count)) {
        const std::string y = units(std::round(side.at(at)));
        path += fmt::format("M{} {}H{}", plot_left, y, plot_right);
        out_.element("text", {{"y", y}}, brief(at));
      }
    });
    out_.empty("path", {{"class", "grid"}, {"d", path}});
    out_.element("text", {{"y", units(side.end - (&side == &position_ ? 25 : 12))}}, title);
  }

  void write_limits() {
    std::vector<double> labelled;
    std::vector<const AxisTrace::Limit*> seen;  // axes often have the same
    for (const AxisTrace& axis : axes_)
      for (const AxisTrace::Limit& limit : axis.limits) {
        const auto same = [&](const AxisTrace::Limit* one) {
          return one->name == limit.name && one->from == limit.from && one->to == limit.to;
        };
        if (std::ranges::none_of(seen, same)) write_limit(limit, labelled);
        seen.push_back(&limit);
      }
  }

  void write_limit(const AxisTrace::Limit& limit, std::vector<double>& labelled) {
    const double from = std::clamp(limit.from, position_.from, position_.to);
    const double to = std::clamp(limit.to, position_.from, position_.to);
    if (from != to)
      out_.empty("path", {{"class", "on"},
                          {"d", fmt::format("M{0} {2}H{1}V{3}H{0}z", plot_left, plot_right,
                                            units(position_.at(from)), units(position_.at(to)))}});
    std::string path;
    for (const double at : {limit.from, limit.to})
      if (position_.has(at) && (path.empty() || limit.from != limit.to))
        path += fmt::format("M{} {}H{}", plot_left, units(position_.at(at)), plot_right);
    if (path.empty()) return;
    out_.empty("path", {{"class", "limit"}, {"d", path}});
    const double y = position_.at(position_.has(limit.to) ? limit.to : limit.from);
    for (const double other : labelled)
      if (std::abs(other - y) < 16) return;
    labelled.push_back(y);
    const double above = y > position_.end + 24 ? y - 3 : y + 13;
    // At the left, where an axis has not yet come to it.
    out_.element("text", {{"class", "at"}, {"x", units(plot_left + 5)}, {"y", units(above)}},
                 limit.name);
  }

  /// Vertical lines; numbers where there is room, "2-4" where there is not.
  void write_marks() {
    if (marks_.empty()) return;
    std::string path, last;
    for (const Mark& one : marks_) {
      const std::string x = units(time_.at(one.ms));
      if (x != last) path += fmt::format("M{} {}V{}", x, position_.end, speed_.begin);
      last = x;
    }
    out_.empty("path", {{"class", "mark"}, {"d", path}});
    Labels labels;
    for (std::size_t i = 0, next = 0; i < marks_.size(); i = next) {
      const double x = time_.at(marks_[i].ms);
      for (next = i; next < marks_.size() && time_.at(marks_[next].ms) - x < label_room;) ++next;
      labels.emplace_back(x,
                          next == i + 1 ? std::to_string(next) : fmt::format("{}-{}", i + 1, next));
    }
    write_row(out_, numbers_base, labels);
  }

  /// What this line alone needs.
  static std::vector<Sample> drawn(std::vector<Sample> samples, double Sample::*what) {
    for (Sample& one : samples) (what == &Sample::speed ? one.position : one.speed) = 0;
    return thinned(samples, most_drawn, finest_drawn);
  }

  void write_lines(const Side& side, double Sample::*what) {
    for (const AxisTrace& axis : axes_) {
      std::string points;
      for (const Sample& one : drawn(axis.samples, what)) {
        const double x = std::clamp(time_.at(ms(one.time)), time_.begin, time_.end);
        points += fmt::format("{}{},{}", points.empty() ? "" : " ", units(std::round(x)),
                              units(side.at(one.*what)));
      }
      out_.empty("polyline", {{"class", colour(axis)}, {"points", points}});
    }
  }

  void write_caption() {
    out_.element("figcaption", {}, [&] {
      for (const AxisTrace& axis : axes_) {
        out_.element("b", {{"class", colour(axis)}}, name(axis));
        for (const AxisTrace::Limit& one : axis.limits)
          out_.text(one.from == one.to
                        ? fmt::format(" {} {};", one.name, one.from)
                        : fmt::format(" {} on {} to {};", one.name, one.from, one.to));
        out_.markup(" ");
      }
      if (marks_.empty()) return;
      out_.element("ol", {}, [&] {
        for (std::size_t i = 0; i < std::min(marks_.size(), most_listed); ++i)
          out_.element("li", {}, fmt::format("{} ms {}", units(marks_[i].ms), marks_[i].what));
      });
      if (marks_.size() > most_listed)
        out_.text(fmt::format("... and {} more", text::grouped(marks_.size() - most_listed)));
    });
  }

  HtmlWriter& out_;
  const std::vector<AxisTrace>& axes_;
  Time zero_;
  std::vector<Mark> marks_;
  Side time_, position_, speed_;
};

// ---- token ----

/// Strokes of one band.
struct Band {
  std::string had, carried;
};

void write_turns(HtmlWriter& out, const NetTrace& net, Time zero) {
  if (net.turns.empty()) return;
  constexpr double top = 10, row = 24;
  const Side time{
      to_ms(net.turns.front().from - zero),
      std::max(to_ms(net.turns.back().to - zero), to_ms(net.turns.front().from - zero) + 1e-3),
      plot_left, plot_right};
  std::map<unsigned, Band> bands;
  for (const TokenTurn& turn : net.turns) bands[turn.station];
  const double bottom = top + row * static_cast<double>(bands.size());
  const auto middle = [&](unsigned station) {
    const auto place = std::distance(bands.begin(), bands.find(station));
    return top + row * (static_cast<double>(place) + 0.5);
  };
  for (const TokenTurn& turn : net.turns) {
    const double x = time.at(to_ms(turn.from - zero)), y = middle(turn.station);
    const double wide = time.at(to_ms(turn.to - zero)) - x;
    bands[turn.station].had += fmt::format("M{} {}h{}", units(x), units(y), units(wide));
    if (turn.busy > 0ns)
      bands[turn.station].carried += fmt::format(
          "M{} {}h{}", units(x), units(y), units(time.at(to_ms(turn.from + turn.busy - zero)) - x));
  }
  const std::string what =
      fmt::format("who had the token of net {}: {} turns", net.net, net.turns.size());
  out.element("figure", {{"class", "trace"}}, [&] {
    write_picture(out, bottom + 24, what, [&] {
      write_times(out, time, top, bottom);
      write_steps(out, [&] {
        for (const auto& [station, band] : bands)
          out.element("text", {{"y", units(middle(station))}}, std::to_string(station));
      });
      for (const auto& [station, band] : bands) {
        out.empty("path", {{"class", "had"}, {"d", band.had}});
        if (!band.carried.empty()) out.empty("path", {{"class", "carried"}, {"d", band.carried}});
      }
    });
    out.element(
        "figcaption", {},
        fmt::format("net {}: the station that has the token, stronger where it carries", net.net));
  });
}

}  // namespace

void write_trace(HtmlWriter& out, const results::CaseResult& result) {
  const Time zero = results::shown_from(result);
  std::vector<AxisTrace> moved = result.trace.axes;
  std::erase_if(moved, [](const AxisTrace& one) { return one.samples.empty(); });
  if (!moved.empty()) Motion(out, moved, zero).write();
  for (const NetTrace& net : result.trace.nets) write_turns(out, net, zero);
}

}  // namespace fieldproof::html
