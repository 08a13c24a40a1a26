#include "reports/history/trend_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reports/compare/compare_statistics.hpp"

namespace fieldproof::history {

using html::HtmlWriter;

namespace {

constexpr double plot_width = 640, plot_height = 150, left = 56, right = 632, top = 22,
                 bottom = 128;
constexpr std::size_t most_points = 160, most_versions = 8;

std::string unit_text(double value) { return fmt::format("{:.1f}", value); }

/// The next of 1, 2, 5, 10, ... at or above.
double round_up(double value) {
  if (value <= 0) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
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
    write_label(out, "y", left - 6, frame.y(value) + 4, fmt::format("{:.4g}", value));
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
  for (const std::size_t at : places) {
    const double x = frame.x(static_cast<double>(at) - 0.5);
    if (at > 0) write_stroke(out, "mark", fmt::format("M{:.1f} {}V{}", x, top - 8, bottom));
    write_label(out, "at", x + 3, top - 10, trend.runs[at].firmware);
  }
}

void write_curve(HtmlWriter& out, const Frame& frame, const Series& series) {
  const std::size_t group = (series.values.size() + most_points - 1) / most_points;
  std::string points;
  for (std::size_t first = 0; first < series.values.size(); first += group) {
    const std::size_t last = std::min(first + group, series.values.size());
    const std::vector<double> values(series.values.begin() + static_cast<std::ptrdiff_t>(first),
                                     series.values.begin() + static_cast<std::ptrdiff_t>(last));
    const double run = static_cast<double>(series.runs[first] + series.runs[last - 1]) / 2;
    points += fmt::format("{}{:.1f},{:.1f}", points.empty() ? "" : " ", frame.x(run),
                          frame.y(compare::median(values)));
  }
  out.empty("polyline", {{"class", "a0"}, {"points", points}});
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
  const Frame frame{trend.runs.size(), round_up(*std::ranges::max_element(series.values) * 1.05)};
  const std::string box = fmt::format("0 0 {} {}", plot_width, plot_height);
  const char* unit = series.is_time ? "ms, median of a run" : "results of a run";
  const std::string what =
      series.change ? fmt::format("{}: {}", series.name, shift_of(series)) : series.name;
  out.element("figure", {{"class", "trace"}}, [&] {
    out.element("svg",
                {{"xmlns", "http://www.w3.org/2000/svg"},
                 {"viewBox", box},
                 {"role", "img"},
                 {"aria-label", what}},
                [&] {
                  write_scale(out, frame, trend);
                  write_versions(out, frame, trend);
                  write_curve(out, frame, series);
                  write_change(out, frame, series);
                });
    out.element("figcaption", {}, [&] {
      out.element("b", {{"class", "a0"}}, series.name);
      out.text(unit);
    });
  });
}

}  // namespace fieldproof::history
