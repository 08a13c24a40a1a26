// The silence that ends what is heard on a line, whatever it is.
#pragma once

#include "src/base/burst.hpp"
#include "src/base/time.hpp"

namespace fieldproof::line {

class Silence {
 public:
  /// The longest between two characters of one frame.
  explicit Silence(Duration longest) : longest_(longest) {}

  void heard(const Burst& burst) {
    last_end_ = burst.end();
    character_time_ = burst.character_time;
  }
  /// Was it over when this began, which has not been heard yet?
  bool is_over_before(const Burst& burst) const { return burst.start - last_end_ > longest_; }
  /// From here on nothing more belongs to what was heard. A character that begins at the last
  /// moment is complete, and heard, one character time later.
  Time over_at() const { return last_end_ + longest_ + character_time_ + Duration(1); }

  /// Of the last character.
  Time last_end() const { return last_end_; }

 private:
  Duration longest_;
  Time last_end_{};
  Duration character_time_{};
};

}  // namespace fieldproof::line
