#include "reports/history/trend_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ranges>

#include "reports/compare/compare_statistics.hpp"

namespace fieldproof::history {

using html::HtmlWriter;

namespace {

constexpr double plot_width = 640, plot_height = 150, left = 56, right = 632, top = 22,
                 bottom = 128;
constexpr double character_width = 9;  // at 400 px, where text is larger
constexpr std::size_t most_points = 160, most_versions = 20;

std::string unit_text(double value) { return fmt::format("{:.1f}", value); }

/// The next of 1, 2, 4, 6, 8, 10, 20, ... at or above.
double round_up(double value) {
  if (value <= 0) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 4.0, 6.0, 8.0})
    if (value <= step * power) return step * power;
  return 10 * power;
}

/// Where things stand in the picture.
struct Frame {
  std::size_t runs = 1;
  double greatest = 1;

  double x(double run) const {
    return left + (right - left) * (run + 0.5) / static_cast<double>(runs);
  }
  double y(double value) const { return bottom - (bottom - top) * value / greatest; }
};

void write_label(HtmlWriter& out, const char* kind, double x, double y, const std::string& text) {
  const std::string at_x = unit_text(x), at_y = unit_text(y);
  out.element("text", {{"class", kind}, {"x", at_x}, {"y", at_y}}, text);
}

void write_stroke(HtmlWriter& out, const char* kind, const std::string& path) {
  out.empty("path", {{"class", kind}, {"d", path}});
}

void write_scale(HtmlWriter& out, const Frame& frame, const Trend& trend) {
  for (const double part : {0.0, 0.5, 1.0}) {
    const double value = frame.greatest * part;
    write_stroke(out, "grid", fmt::format("M{} {:.1f}H{}", left, frame.y(value), right));
    write_label(out, "y", left - 6, frame.y(value) + 4,
                value < 1000 ? fmt::format("{:.4g}", value)
                             : text::grouped(static_cast<std::size_t>(value)));
  }
  const auto day = [](const RunEntry& run) { return run.started.substr(0, 10); };
  write_label(out, "at", left, bottom + 17, day(trend.runs.front()));
  if (day(trend.runs.back()) != day(trend.runs.front()))
    write_label(out, "y", right, bottom + 17, day(trend.runs.back()));
}

/// Where the firmware is another than in the run before.
void write_versions(HtmlWriter& out, const Frame& frame, const Trend& trend) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < trend.runs.size(); ++i)
    if (i == 0 || trend.runs[i].firmware != trend.runs[i - 1].firmware) places.push_back(i);
  if (places.size() > most_versions || places.size() < 2) return;
  double free = 0;  // from here on no label stands
  for (const std::size_t at : places) {
    const double x = frame.x(static_cast<double>(at) - 0.5);
    if (at > 0) write_stroke(out, "mark", fmt::format("M{:.1f} {}V{}", x, top - 8, bottom));
    if (x < free) continue;
    write_label(out, "at", x + 3, top - 10, trend.runs[at].firmware);
    free = x + character_width * static_cast<double>(trend.runs[at].firmware.size() + 1);
  }
}

/// Run and value of what is drawn: of many runs, neighbours together.
std::vector<std::pair<double, double>> points_of(const Series& series) {
  const std::size_t group = (series.values.size() + most_points - 1) / most_points;
  std::vector<std::pair<double, double>> points;
  for (std::size_t first = 0; first < series.values.size(); first += group) {
    const std::size_t last = std::min(first + group, series.values.size());
    const auto begin = series.values.begin();
    points.emplace_back(static_cast<double>(series.runs[first] + series.runs[last - 1]) / 2,
                        compare::median({begin + static_cast<std::ptrdiff_t>(first),
                                         begin + static_cast<std::ptrdiff_t>(last)}));
  }
  return points;
}

void write_curve(HtmlWriter& out, const Frame& frame,
                 const std::vector<std::pair<double, double>>& points) {
  std::string text;
  for (const auto& [run, value] : points)
    text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", frame.x(run), frame.y(value));
  out.empty("polyline", {{"class", "a0"}, {"points", text}});
}

void write_change(HtmlWriter& out, const Frame& frame, const Series& series) {
  if (!series.change) return;
  const std::size_t before = series.runs[series.change->at - 1],
                    after = series.runs[series.change->at];
  const double x = frame.x(static_cast<double>(before + after) / 2);
  write_stroke(out, "limit", fmt::format("M{:.1f} {}V{}", x, top - 4, bottom));
}

}  // namespace

void write_trend_plot(HtmlWriter& out, const Trend& trend, const Series& series) {
  const std::vector<std::pair<double, double>> points = points_of(series);
  const double greatest = std::ranges::max(points | std::views::values);
  const Frame frame{trend.runs.size(), round_up(greatest * 1.05)};
  const char* unit = series.is_time ? "ms, median of a run" : "results of a run";
  const std::string what =
      series.change ? fmt::format("{}: {}", series.name, shift_of(series)) : series.name;
  out.element("figure", {{"class", "trace"}}, [&] {
    out.picture(fmt::format("{} {}", plot_width, plot_height), what, [&] {
      write_scale(out, frame, trend);
      write_versions(out, frame, trend);
      write_curve(out, frame, points);
      write_change(out, frame, series);
    });
    out.element("figcaption", {}, [&] {
      out.element("b", {{"class", "a0"}}, series.name);
      out.text(unit);
    });
  });
}

}  // namespace fieldproof::history
