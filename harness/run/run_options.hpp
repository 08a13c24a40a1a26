// What `run` is asked for.
#pragma once

#include <string>
#include <vector>

namespace fieldproof::run {

struct RunOptions {
  std::string endpoint;  // empty: of the bench file's device, else "emulator:"
  std::string profile;   // empty: by the endpoint
  std::string filter;
  std::string protocol;  // which of the profile's; empty: see RunPlan
  std::string vectors;   // empty: the tool's own
  std::string out = "fieldproof-out";
  std::string junit, json, html;  // empty: in `out`
  std::string capture, csv;       // empty: none
  std::string bench;              // bench file
  std::vector<std::string> duts;  // devices of it; several share the cases
  std::string journal;            // empty: in `out`
  bool discard_journal = false;   // forget what an earlier run did not put back
  std::string waivers;
  std::string baseline;  // results of an earlier run, to compare with; "last": of the history
  std::string history;   // where this run is added at its end; empty: nowhere
  std::string power_cycle;
  std::string role;      // "client", "server"; empty: both
  std::string stimulus;  // what makes a device ask: a command, or "-": the program of exec:
  std::string control;   // what sets a device up: a command, or "-": the program of exec:
  std::string aux;       // a second channel of the PLC under test
  std::vector<std::string> allow_write;
  std::vector<std::string> allow_motion;  // axes
  bool derived = false;                   // what follows from the cases by rule, too
  bool read_only = false;                 // nothing is written, to no device
  std::vector<std::string> gtest_arguments;
  std::string floor;        // the link's own uncertainty: "2ms"; empty: measured
  std::string loop;         // endpoint with an emulator behind it, to measure the link with
  std::string matrix;       // line settings to repeat the cases with: "38400 x 8N1,8E1"
  std::string reconfigure;  // command that sets the device for a step of the matrix; empty: the
                            // engineer does
  std::string duration;     // soak: "8h"
  std::string wait_port;    // how long a port that is absent or in use is waited for: "10m"
  int seed = -1;            // >= 0: shuffled by it
  int repeat = 1;
  int max_restarts = 20;  // of a device that the bench starts itself
  int max_failures = 0;   // then the rest is not run; 0: no limit
  bool strict = false, qualify = false, fail_on_marginal = false;
  double min_judged = 0;  // percent; 0: any
  bool fail_fast = false, dry_run = false, verbose = false, skip_absent = false;
  std::string command;  // as typed, for reports
};

}  // namespace fieldproof::run
