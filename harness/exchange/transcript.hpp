// What happened between bench and device during a case: the only thing the judge sees of it. Bytes
// stand in the events alone; which step took them, each event says.
#pragma once

#include <list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reports/results/case_result.hpp"
#include "src/base/result.hpp"

namespace fieldproof::exchange {

/// What an executed step came to, besides its events.
struct StepRecord {
  Time cause{};  // expect, expect_open or _close: the end of what it answers (a transmission, the
                 // reply before it, a set, do, open or close); wait: when it is over
  Time deadline{};  // the same: the limit for the first byte, or for the event
  std::vector<std::pair<std::string, std::string>> memory;  // check: address and what it held
  std::string refused;                                      // any step: why it could not be done
  bool refused_by_device = false;
  bool passed_over = false;  // check: PreparedStep::passed_over
};

struct Transcript {
  using Events = std::list<results::Event>;
  Events events;                  // frame monitor, in the order of time
  std::vector<StepRecord> steps;  // one a step as far as the case went
  Trace trace;                    // of a model
  bool flooded = false;           // the device sends without end, be it fast or slowly
  std::string dead;               // set when nothing answered after the case
  std::optional<Error> trouble;   // the port failed, or Ctrl-C
};

/// Bytes with the moments at which they came.
struct Received {
  struct Arrival {
    std::size_t offset = 0;  // of its first byte
    Time start{};
    Time end{};
  };
  Bytes bytes;
  std::vector<Arrival> arrivals;  // an empty datagram is one without bytes
  std::string link;               // on which the first of them came
};

/// The device has ended a link, or refused it.
struct Ending {
  const results::Event* event = nullptr;  // none
  std::size_t received = 0, sent = 0;     // bytes that the link had carried before

  explicit operator bool() const { return event != nullptr; }
  bool refused() const;  // before anything went over it
};

/// What one executed step sent, and what came for it.
struct Share {
  Bytes sent;
  Received received;
  Ending ending;
  const results::Event* opened = nullptr;  // a connection of the device, expected
};

struct Shares {
  std::vector<Share> steps;  // one for each executed step
  Share surplus;             // what no step was waiting for: bytes of the first link that has such
};

/// Points into the transcript.
Shares shares_of(const Transcript& transcript);

/// Is what the device said last still without a word of the bench behind it?
bool leaves_open(const Transcript& transcript);

}  // namespace fieldproof::exchange
