// What a bench is told: the device, the ways to it, and what may be done to it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "harness/bench/files/profile.hpp"
#include "harness/endpoints/controlled.hpp"
#include "harness/exchange/client_program.hpp"
#include "harness/exchange/prepared_case.hpp"
#include "harness/safety/fence.hpp"
#include "harness/safety/journal.hpp"
#include "harness/vectors/case.hpp"

namespace fieldproof::bench {

/// Behind a pty or a socket writes can arrive milliseconds apart, and the emulator's
/// inter-character time has a floor of 20 ms: shorter times than this prove nothing there.
inline constexpr Duration shortest_judged = 100ms;

struct BenchOptions {
  Profile profile;
  safety::WriteFence fence;
  int station = 1;  // the device's, where the endpoint cannot become another station
  std::string power_cycle_command;    // --power-cycle: what switches a real device off and on
  int max_restarts = 20;              // --max-restarts (WorthAsking)
  std::string replay;                 // command line that the id of the case completes
  exchange::Channel aux;              // --aux: a second channel of the PLC under test
  harness::Protocols known{{}};       // of further services that a case speaks to
  exchange::ClientProgram stimulus;   // --stimulus: what makes the device ask; empty: none
  bool endpoint_is_stimulus = false;  // --stimulus -: the endpoint's own program is told
  std::vector<const vectors::Case*>
      client_cases;  // all that are selected, where every one of them is of a device that asks
  endpoints::ControlProgram control;         // --control: what sets the device up; empty: none
  bool endpoint_is_control = false;          // --control -: the endpoint's own program is told
  safety::JournalDevice device;              // for the journal of a real device
  safety::JournalDevice aux_device;          // of `aux`
  std::shared_ptr<safety::Journal> journal;  // without one nothing is written to a real device
};

}  // namespace fieldproof::bench
