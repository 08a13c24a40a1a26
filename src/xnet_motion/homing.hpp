// Return to origin as a sequence of edges (X-NET 2-3-3): modes 0, 2, 10 and 12, forward and
// reverse.
#pragma once

namespace fieldproof::xnet {

/// Of the axis's terminals.
struct Signals {
  bool min = false, max = false, close = false, origin = false;
};

class Homing {
 public:
  struct Speeds {
    double high = 0, low = 0, creep = 0;
  };
  /// `mode`: SFD3038. `direction`: 1 forward, -1 reverse.
  Homing(int mode, double direction, Speeds speeds, Signals now);

  enum class Wish { go, find_z, done, failed };
  struct Step {
    Wish wish = Wish::go;
    double speed = 0;  // with its sign
  };
  /// What to do after this look at the signals; `speed` is that of the axis. An edge counts once
  /// the axis goes the way of its phase, not while it still turns.
  Step look(Signals now, double speed);

 private:
  /// To the origin; where a hard limit came first: back past the origin, and again; then the edge.
  enum class Phase { seeking, backing, seeking_again, creeping };

  Step advance(Signals now, double speed);
  double wished_speed() const;
  bool is_hard() const { return mode_ >= 10; }
  bool at_limit(Signals now) const { return direction_ > 0 ? now.max : now.min; }

  int mode_;
  double direction_;
  Speeds speeds_;
  Signals last_;
  Phase phase_ = Phase::seeking;
  bool slow_ = false;  // the close signal was met
};

}  // namespace fieldproof::xnet
