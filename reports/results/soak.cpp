#include "reports/results/soak.hpp"

#include <fmt/format.h>

namespace fieldproof::results {

namespace {

double rate(const SoakSample& sample) {
  return sample.judged == 0
             ? 0
             : 100.0 * static_cast<double>(sample.failed) / static_cast<double>(sample.judged);
}

std::string times(std::uint64_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// How the median moved, in words.
std::string shift(double first, double last) {
  if (first <= 0 || last == first) return "the same";
  return fmt::format("{:+.1f} %", 100 * (last / first - 1));
}

}  // namespace

std::string soak_text(const SoakSummary& soak) {
  std::string text =
      fmt::format("soak       {:.0f} s of {:.0f} s: {}, {}, {} red, error rate {:.4g} %\n",
                  soak.seconds, soak.planned_s, times(soak.rounds, "round"),
                  times(soak.judged, "judged repetition"), soak.failed, 100 * soak.error_rate());
  if (soak.response.count > 0) text += fmt::format("replies    {}\n", to_string(soak.response));
  if (soak.first.response.count > 0 && soak.last.response.count > 0)
    text += fmt::format(
        "drift      first tenth median {:.3f}, p99 {:.3f} ms, {:.4g} % red; last tenth median "
        "{:.3f}, p99 {:.3f} ms, {:.4g} % red: median {}\n",
        soak.first.response.median, soak.first.response.p99, rate(soak.first),
        soak.last.response.median, soak.last.response.p99, rate(soak.last),
        shift(soak.first.response.median, soak.last.response.median));
  if (soak.unwritten > 0)
    text += fmt::format("failures   {} more are counted, not written in full\n", soak.unwritten);
  return text;
}

std::string killed_soak_text(const std::vector<SoakSample>& samples) {
  if (samples.empty()) return "";
  SoakSample all{0, samples.back().to_s};
  for (const SoakSample& one : samples) {
    all.judged += one.judged;
    all.failed += one.failed;
  }
  std::string text = fmt::format("{:.0f} s of soak: {}, {} red", all.to_s,
                                 times(all.judged, "judged repetition"), all.failed);
  const ResponseFigures& first = samples.front().response;
  const ResponseFigures& last = samples.back().response;
  if (first.count > 0 && last.count > 0)
    text +=
        fmt::format("; median {:.3f} ms at first, {:.3f} ms at last", first.median, last.median);
  return text;
}

}  // namespace fieldproof::results
