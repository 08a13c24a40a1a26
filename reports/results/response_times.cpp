#include "reports/results/response_times.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace fieldproof::results {

namespace {

constexpr double shortest = 1e-3;  // ms; what is below is one bin

/// A bin is one percent wide.
int bin_of(double ms) {
  return ms < shortest ? -1
                       : static_cast<int>(std::floor(std::log(ms / shortest) / std::log(1.01)));
}

}  // namespace

void ResponseTimes::add(double ms) {
  Bin& bin = bins_[bin_of(ms)];
  ++bin.count;
  bin.mean += (ms - bin.mean) / static_cast<double>(bin.count);
  least_ = count_ == 0 ? ms : std::min(least_, ms);
  greatest_ = count_ == 0 ? ms : std::max(greatest_, ms);
  ++count_;
}

void ResponseTimes::add(const ResponseTimes& other) {
  if (other.count_ == 0) return;
  for (const auto& [index, more] : other.bins_) {
    Bin& bin = bins_[index];
    bin.count += more.count;
    bin.mean +=
        (more.mean - bin.mean) * static_cast<double>(more.count) / static_cast<double>(bin.count);
  }
  least_ = count_ == 0 ? other.least_ : std::min(least_, other.least_);
  greatest_ = count_ == 0 ? other.greatest_ : std::max(greatest_, other.greatest_);
  count_ += other.count_;
}

double ResponseTimes::percentile(double part) const {
  const auto rank = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(count_))));
  if (rank >= count_) return greatest_;
  std::uint64_t seen = 0;
  for (const auto& [index, bin] : bins_) {
    seen += bin.count;
    if (seen >= rank) return std::clamp(bin.mean, least_, greatest_);
  }
  return greatest_;
}

ResponseFigures figures_of(const ResponseTimes& times) {
  return {times.count(), times.least(), times.median(), times.percentile(0.99), times.greatest()};
}

std::string to_string(const ResponseFigures& figures) {
  return fmt::format("{} {}: min {:.3f}, median {:.3f}, p99 {:.3f}, max {:.3f} ms", figures.count,
                     figures.count == 1 ? "reply" : "replies", figures.least, figures.median,
                     figures.p99, figures.greatest);
}

}  // namespace fieldproof::results
