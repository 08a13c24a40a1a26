// What happened on the line during a case: the only thing the judge sees of it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/endpoints/endpoint.hpp"
#include "reports/results/case_result.hpp"

namespace fieldproof::exchange {

/// Bytes with the moments at which they came.
struct Received {
  struct Arrival {
    std::size_t offset = 0;  // of its first byte
    Time start{};
    Time end{};
    std::size_t event =
        0;  // which of the transcript's events it stands in, and its first byte there
    std::size_t event_offset = 0;
  };
  Bytes bytes;
  std::vector<Arrival> arrivals;

  void add(const Burst& burst, std::size_t event = 0);
  void append(Received other);
  /// Takes the first `count` bytes out.
  Received take(std::size_t count);
};

struct StepRecord {
  Sent sent;          // send: when
  Time stimulus{};    // expect: the end of what it answers (a transmission, the reply before it, a
                      // set or do)
  Bytes sent_bytes;   // send
  Received received;  // expect, silence, wait: what came
  Time deadline{};    // expect: the limit for the first byte
  Time listened_until{};
  std::vector<std::pair<std::string, std::string>> memory;  // check: address and what it held
  std::string refused;  // set, check, do: why it could not be done
  bool refused_by_device = false;
};

struct Transcript {
  std::vector<StepRecord> steps;  // one a step as far as the case went
  Received surplus;               // bytes that no step was waiting for
  std::size_t surplus_after = 0;  // the step they followed
  bool flooded = false;
  std::string dead;                    // set when the link was silent after the case
  std::optional<Error> trouble;        // the port failed, or Ctrl-C
  std::vector<results::Event> events;  // frame monitor
};

}  // namespace fieldproof::exchange
