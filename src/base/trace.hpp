// What a model of machines did over time, for pictures: axes that moved, and who had the token.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "src/base/time.hpp"

namespace fieldproof {

struct AxisTrace {
  struct Sample {
    Time time{};
    double position = 0, speed = 0;  // pulses, pulses a second
  };
  struct Event {
    Time time{};
    std::string what;  // "MOTO 10000 5000 50", "error 20003"
  };
  /// A limit (`from` and `to` alike), or a switch that is on from..to.
  struct Limit {
    std::string name;
    double from = 0, to = 0;  // pulses
  };

  std::string axis;             // "1"; "B:1" is of the PLC called B
  std::vector<Sample> samples;  // in the order of time, straight lines between them
  std::vector<Event> events;    // in the order of time
  std::vector<Limit> limits;
};

/// One turn with the token of a bus.
struct TokenTurn {
  unsigned station = 0;
  Time from{}, to{};
  Duration busy{};      // of it, carrying
  unsigned of = 0;      // so many stations shared the cycle when it began
  bool begins = false;  // nobody was there before it
};

struct NetTrace {
  unsigned net = 0;
  std::vector<TokenTurn> turns;  // in the order of time; gaps where nobody was there
  Duration cycle{};              // in which each station has the token once
};

struct Trace {
  std::vector<AxisTrace> axes;
  std::vector<NetTrace> nets;

  bool empty() const { return axes.empty() && nets.empty(); }
};

/// First, last and extreme samples stay, then those that the straight lines between the kept ones
/// miss most, until `missed` of the range is missed nowhere, or `most` are kept (six at least).
std::vector<AxisTrace::Sample> thinned(const std::vector<AxisTrace::Sample>& samples,
                                       std::size_t most, double missed = 1e-3);

}  // namespace fieldproof
