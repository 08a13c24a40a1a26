// From all that a search has heard to findings in words. Pure.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "harness/probe/prober.hpp"

namespace fieldproof::probe {

struct Finding {
  enum class Kind {
    device,         // answers, nothing wrong with it
    echo,           // our own question comes back
    two_devices,    // two replies to one question, or replies that run into one another
    stray_bytes,    // around right replies
    unstable,       // some questions are answered, some not
    other_station,  // answers, but names another station than the one that was asked
    other_talker,   // frames that answer nothing we asked: another master, or a device that is set
                    // as client
    format,         // readable with another parity or number of data bits
    wiring,         // garbage at all settings: A and B swapped, no bias, no ground
    silence
  };
  Kind kind = Kind::silence;
  Trial trial;         // device, and where it showed itself
  std::string text;    // one sentence
  std::string advice;  // what to do; may be empty

  bool is_problem() const { return kind != Kind::device; }
};
std::string_view to_string(Finding::Kind kind);

/// Devices first, each with what is wrong with it; without a device what is wrong with the line,
/// the surest first. Never empty.
std::vector<Finding> conclude(const Search& search, const ProbeTiming& timing);

}  // namespace fieldproof::probe
