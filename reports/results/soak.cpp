#include "reports/results/soak.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fieldproof::results {

namespace {

using nlohmann::json;

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

void to_json(json& object, const SoakSample& sample) {
  object = {{"from_s", sample.from_s},
            {"to_s", sample.to_s},
            {"judged", sample.judged},
            {"failed", sample.failed},
            {"response", sample.response}};
}

void from_json(const json& object, SoakSample& sample) {
  object.at("from_s").get_to(sample.from_s);
  object.at("to_s").get_to(sample.to_s);
  object.at("judged").get_to(sample.judged);
  object.at("failed").get_to(sample.failed);
  object.at("response").get_to(sample.response);
}

void to_json(json& object, const SoakCase& one) {
  object = {{"counts", one.counts}, {"response", one.response}};
}

void from_json(const json& object, SoakCase& one) {
  object.at("counts").get_to(one.counts);
  object.at("response").get_to(one.response);
}

void to_json(json& object, const SoakSummary& soak) {
  object = {{"seconds", soak.seconds},   {"planned_s", soak.planned_s},
            {"rounds", soak.rounds},     {"judged", soak.judged},
            {"failed", soak.failed},     {"error_rate", soak.error_rate()},
            {"response", soak.response}, {"first_tenth", soak.first},
            {"last_tenth", soak.last},   {"unwritten", soak.unwritten},
            {"cases", soak.cases}};
}

void from_json(const json& object, SoakSummary& soak) {
  object.at("seconds").get_to(soak.seconds);
  object.at("planned_s").get_to(soak.planned_s);
  object.at("rounds").get_to(soak.rounds);
  object.at("judged").get_to(soak.judged);
  object.at("failed").get_to(soak.failed);
  object.at("response").get_to(soak.response);
  object.at("first_tenth").get_to(soak.first);
  object.at("last_tenth").get_to(soak.last);
  object.at("unwritten").get_to(soak.unwritten);
  object.at("cases").get_to(soak.cases);
}

}  // namespace fieldproof::results
