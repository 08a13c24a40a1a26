// From what was heard around one question to what it means. Pure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/probe/plan.hpp"
#include "src/line/device.hpp"

namespace fieldproof::probe {

/// What came around one question.
struct Heard {
  std::vector<Burst> before;  // nobody had asked: the line was to be silent
  Time asked_until{};         // the end of the question's last stop bit
  std::vector<Burst> after;   // since the question began; the echo of our own transmitter too
  std::string errors;         // as Endpoint::line_errors gives them

  bool silent() const { return before.empty() && after.empty() && errors.empty(); }
};
Bytes all_bytes(const std::vector<Burst>& bursts);

enum class Symptom {
  silence,
  reply,          // a whole frame with right checks, of the station and protocol that was asked
  second_reply,   // and another one behind it, to one question
  other_station,  // a whole frame, but of a station that was not asked
  foreign_frame,  // a whole frame of another protocol, or of one who asks
  format,         // readable with another character format: `right_format`
  damaged,        // begins as the reply, then goes wrong
  inverted,       // a whole frame when each bit is inverted
  garbage         // bytes or line errors without sense
};
/// "silence", "reply", "another station answers", ...
std::string_view to_string(Symptom symptom);

struct Diagnosis {
  Symptom symptom = Symptom::silence;
  bool echo = false;                            // our own question came back first
  std::size_t stray = 0;                        // bytes around the reply that belong to no frame
  const harness::Protocol* protocol = nullptr;  // of the frame
  int station = -1;                             // that the frame names
  Bytes frame{};                                // the reply, or what came instead
  std::optional<Duration>
      response_time{};  // the question's last stop bit to the reply's first start bit
  std::optional<line::LineSettings> right_format{};
};

/// `known`: the protocols whose frames are recognised besides the one that was asked. A trial
/// without a protocol asks nothing: what was heard before is looked at.
Diagnosis diagnose(const Trial& trial, const Heard& heard, const harness::Protocols& known);

/// Bytes in notation, cut where there are many: "ACK '01rSS' 'A4' FF ... (312 bytes)".
std::string shown(ByteView bytes);

}  // namespace fieldproof::probe
