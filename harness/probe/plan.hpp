// What a search for a device asks, in which order. Pure.
#pragma once

#include <string_view>
#include <vector>

#include "harness/protocols.hpp"
#include "src/line/settings.hpp"

namespace fieldproof::probe {

/// One question on the line: is there this station, with this protocol, at these settings?
struct Trial {
  line::LineSettings line;
  const harness::Protocol* protocol = nullptr;  // nullptr: nothing is asked, the bench listens
  int station = 0;

  bool operator==(const Trial&) const = default;
};
/// "xgt-cnet station 1", "listening"
std::string question_of(const Trial& trial);
/// "9600-8N1 xgt-cnet station 1"
std::string to_string(const Trial& trial);

/// Only lines are searched, and only by a harmless request.
bool can_be_searched(const harness::Protocol& protocol);

/// What is searched; an empty list means all that is usual.
struct SearchSpace {
  std::vector<int> speeds;  // the eight of Cnet EN table 4.3.1
  std::vector<line::LineSettings>
      frames;  // their speed does not count; one stop bit: a second one reads the same
  std::vector<int> stations;  // 0 to 31: what one line carries (Cnet EN 9.3); more only when named
  std::vector<const harness::Protocol*> protocols;  // those known that can be searched
  bool settable =
      true;  // false: a socket or a pty has neither speed nor frame, one setting is tried
};
/// The same with the usual in place of the empty lists.
SearchSpace filled(SearchSpace space, const harness::Protocols& known);

/// Each question of the space once, the most likely first; none with binary bytes over 7 data bits.
std::vector<Trial> make_plan(const SearchSpace& space, const harness::Protocols& known);

/// How long the plan takes when nothing is heard: each question on the wire, `wait` for its answer,
/// and what opening the line costs where the settings change.
Duration longest_time(const std::vector<Trial>& plan, Duration wait);

/// A new setting is listened to for so long before the first question.
Duration listening_time(const line::LineSettings& line);

}  // namespace fieldproof::probe
