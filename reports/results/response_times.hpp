// Response times of many repetitions in little memory: counted in bins of one percent, each with
// its own mean, so that equal times (simulated time) stay exact and others are off by less than
// half a percent. Least and greatest are exact.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace fieldproof::results {

class ResponseTimes {
 public:
  void add(double ms);
  void add(const ResponseTimes& other);

  std::uint64_t count() const { return count_; }
  double least() const { return least_; }
  double greatest() const { return greatest_; }
  /// The time below which `part` (0 to 1) of them lie, by nearest rank; 0 where there is none.
  double percentile(double part) const;
  double median() const { return percentile(0.5); }
  /// How many numbers are kept; grows with their spread, not with their count.
  std::size_t bins() const { return bins_.size(); }
  /// `visit(ms, count)` for each number that is kept, in order.
  void each(const auto& visit) const {
    for (const auto& [index, bin] : bins_) visit(bin.mean, bin.count);
  }

 private:
  struct Bin {
    std::uint64_t count = 0;
    double mean = 0;
  };
  std::map<int, Bin> bins_;
  std::uint64_t count_ = 0;
  double least_ = 0, greatest_ = 0;
};

/// What a report says of response times, in milliseconds.
struct ResponseFigures {
  std::uint64_t count = 0;
  double least = 0, median = 0, p99 = 0, greatest = 0;
};
ResponseFigures figures_of(const ResponseTimes& times);

/// "1000 replies: min 1.042, median 1.042, p99 2.083, max 2.083 ms"
std::string to_string(const ResponseFigures& figures);

}  // namespace fieldproof::results
