#include "reports/html/html_timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace fieldproof::html {

using results::ResponseTimes;

namespace {

constexpr double width = 400, left = 8, right = 392, height = 30, base = 24;
constexpr std::size_t bins = 96;

std::string number(double value) { return fmt::format("{:.1f}", value); }

/// Whole decades of milliseconds across the plot.
struct Scale {
  int first = 0, last = 1;  // powers of ten

  /// What is below the first decade (0 on simulated time) stands at the left edge.
  double x(double ms) const {
    const double decade = ms > 0 ? std::log10(ms) : first;
    return left +
           (right - left) * (std::clamp<double>(decade, first, last) - first) / (last - first);
  }
};

Scale scale_of(const std::map<std::string, ResponseTimes>& response_ms, double limit_ms) {
  double least = 1e9, greatest = std::max(limit_ms, 1e-3);
  for (const auto& [group, times] : response_ms) {
    greatest = std::max(greatest, times.greatest());
    times.each([&](double ms, std::uint64_t) {
      if (ms > 0) least = std::min(least, ms);
    });
  }
  Scale scale;
  scale.last = static_cast<int>(std::ceil(std::log10(std::min(greatest, 1e9))));
  scale.first = std::clamp(static_cast<int>(std::floor(std::log10(std::min(least, 1.0)))), -3,
                           scale.last - 1);
  return scale;
}

/// Bars of one path. Heights by square root: one slow answer among a thousand must still be seen.
std::string histogram(const ResponseTimes& times, const Scale& scale) {
  std::array<std::uint64_t, bins> counts{};
  const double bin_width = (right - left) / bins;
  times.each([&](double ms, std::uint64_t count) {
    const auto bin = static_cast<std::size_t>((scale.x(ms) - left) / bin_width);
    counts[std::min(bins - 1, bin)] += count;
  });
  const double most = std::sqrt(static_cast<double>(*std::ranges::max_element(counts)));
  std::string path;
  for (std::size_t i = 0; i < bins; ++i) {
    if (counts[i] == 0) continue;
    const double bar = std::max(2.0, (base - 4) * std::sqrt(static_cast<double>(counts[i])) / most);
    path += fmt::format("M{:.1f} {}v-{:.1f}h{:.1f}v{:.1f}z",
                        left + bin_width * static_cast<double>(i), base, bar, bin_width, bar);
  }
  return path;
}

void line(HtmlWriter& out, std::string_view css, double x, double top, double bottom) {
  out.empty("path",
            {{"class", css}, {"d", fmt::format("M{:.1f} {}V{}", x, number(top), number(bottom))}});
}

void decades(HtmlWriter& out, const Scale& scale) {
  for (int power = scale.first; power <= scale.last; ++power)
    line(out, "grid", scale.x(std::pow(10, power)), 0, base);
}

void write_plot(HtmlWriter& out, const ResponseTimes& times, const Scale& scale, double limit_ms) {
  const std::string what = fmt::format("{:.3f} to {:.3f} ms, median {:.3f} ms", times.least(),
                                       times.greatest(), times.median());
  out.picture(fmt::format("{} {}", width, height), what, [&] {
    decades(out, scale);
    out.empty("path", {{"class", "bars"}, {"d", histogram(times, scale)}});
    const double low = scale.x(times.percentile(0.25)), high = scale.x(times.percentile(0.75));
    out.empty("path",
              {{"class", "box"},
               {"d", fmt::format("M{:.1f} {}H{:.1f}", low, base + 3, std::max(high, low + 1))}});
    line(out, "median", scale.x(times.median()), base, height);
    if (limit_ms > 0) line(out, "limit", scale.x(limit_ms), 0, height);
  });
}

void write_axis(HtmlWriter& out, const Scale& scale) {
  out.picture(fmt::format("{} 14", width), "milliseconds", [&] {
    for (int power = scale.first; power <= scale.last; ++power) {
      const char* anchor = power == scale.first ? "start" : power == scale.last ? "end" : "middle";
      const double x = power == scale.first  ? 0
                       : power == scale.last ? width
                                             : scale.x(std::pow(10, power));
      const std::string label =
          fmt::format("{:g}{}", std::pow(10, power), power == scale.last ? " ms" : "");
      out.element("text", {{"x", number(x)}, {"y", "11"}, {"text-anchor", anchor}}, label);
    }
  });
}

double limit_of(const results::RunInfo& run) {
  const auto found = run.properties.find("response_max_ms");
  return found == run.properties.end() ? 0
                                       : std::max(0.0, std::strtod(found->second.c_str(), nullptr));
}

}  // namespace

void write_timing(HtmlWriter& out, const std::map<std::string, ResponseTimes>& response_ms,
                  double limit_ms) {
  const Scale scale = scale_of(response_ms, limit_ms);
  out.element("table", {{"class", "timing"}}, [&] {
    out.element("thead", {}, [&] {
      out.element("tr", {}, [&] {
        out.element("th", {}, "cases");
        out.element("th", {{"class", "plot"}}, [&] { write_axis(out, scale); });
        for (const char* head : {"replies", "least", "median", "99 %", "greatest"})
          out.element("th", {{"class", "num"}}, head);
      });
    });
    out.element("tbody", {}, [&] {
      for (const auto& [group, times] : response_ms) {
        out.element("tr", {}, [&] {
          out.element("td", {}, group);
          out.element("td", {{"class", "plot"}}, [&] { write_plot(out, times, scale, limit_ms); });
          out.element("td", {{"class", "num"}}, fmt::format("{}", times.count()));
          for (const double ms :
               {times.least(), times.median(), times.percentile(0.99), times.greatest()})
            out.element("td", {{"class", "num"}}, fmt::format("{:.3f}", ms));
        });
      }
    });
  });
}

void write_times(HtmlWriter& out, const std::map<std::string, ResponseTimes>& response_ms,
                 const results::RunInfo& run) {
  if (response_ms.empty()) return;
  const double limit = limit_of(run);
  out.element("h2", {}, "Response times");
  out.element(
      "p", {},
      fmt::format("From the request's last byte to the reply's first, in milliseconds on a "
                  "logarithmic scale{}. Bars count "
                  "replies (by square root), the line below them spans the middle half, the tick "
                  "is the median.",
                  limit > 0 ? fmt::format("; dashed: the profile's limit of {:g} ms", limit) : ""));
  write_timing(out, response_ms, limit);
}

}  // namespace fieldproof::html
