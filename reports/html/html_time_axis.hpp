// Where the moments of an exchange are drawn.
#pragma once

#include <map>
#include <vector>

#include "reports/results/case_result.hpp"

namespace fieldproof::html {

/// To scale, but for silences that would leave no room for frames.
class TimeAxis {
 public:
  /// From `left` to `right`, in units of the picture.
  TimeAxis(const std::vector<const results::Event*>& events, const results::Due& due, double left,
           double right);

  double x(Time moment) const;
  /// The middles of silences that are drawn shorter than they are.
  std::vector<double> cuts() const;

 private:
  struct Piece {
    Time from{}, to{};
    double wide = 0;
    bool cut = false;
  };
  void scale_pieces(const std::vector<const results::Event*>& events);

  double left_;
  std::vector<Piece> pieces_;
  std::map<Time, double> x_;
};

}  // namespace fieldproof::html
