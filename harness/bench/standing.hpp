// What a bench knows of its device from case to case.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "harness/bench/adapter_floor.hpp"
#include "harness/bench/set_up_findings.hpp"
#include "harness/bench/worth_asking.hpp"
#include "harness/judge/readings.hpp"
#include "src/base/time.hpp"

namespace fieldproof::bench {

/// What is known of a device, however it is set up.
struct Standing {
  explicit Standing(int max_restarts) : worth_asking(max_restarts) {}

  judging::Readings readings;
  SetUpFindings set_up_findings;
  WorthAsking worth_asking;
  std::optional<AdapterFloor> floor;  // nothing: what is declared
  std::string stopped;                // why no further case can run
  nlohmann::json config;              // that the device was given last
  int errors_in_a_row = 0;
  int set_ups_unanswered = 0;  // in a row, of a device that answers otherwise
  unsigned starts = 0;         // of the endpoint, when the device was last seen to answer
  bool port_failed = false;
  bool answers = false;  // the device answers probes
  bool interrupted = false;
  bool client_gave_up = false;  // the program under test, in some case
  Time simulated{};             // where the cases so far end, on simulated time
  bool claimed = false;         // a shared line: nobody else was heard before the first case
  int disturbed = 0;            // cases in which somebody else was heard, without a pause
  Time doubt_until{};           // what fails until then may be the work of who was heard last
};

}  // namespace fieldproof::bench
