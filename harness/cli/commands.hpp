// The commands of the tool. Each takes its options as a value and returns the exit code of DESIGN's
// table.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "harness/protocols.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/run_options.hpp"

namespace fieldproof::cli {

int run_command(const run::RunOptions& options, const harness::Protocols& protocols);

struct ExploreOptions {
  run::RunOptions run;         // device, fence, gate and reports; `seed` -1: by the clock
  std::uint64_t requests = 0;  // then it ends; 0: by `run.duration`, 100,000, or 10 minutes
};
/// Requests that no vector has, against the device and our own model of it.
int explore_command(const ExploreOptions& options, const harness::Protocols& protocols);

struct ListOptions {
  std::string filter, vectors;
  std::string role;           // "client", "server"; empty: both
  bool coverage = false;      // statements instead of cases
  bool redundant = false;     // cases that no fault tells apart
  std::string results, html;  // with coverage: verdicts of a run; a report
  double min_coverage = 0;    // with coverage: percent of the statements
  bool json = false, markdown = false;
};
int list_command(const ListOptions& options, const harness::Protocols& protocols);

struct LintOptions {
  std::string vectors;
  std::string manuals;  // folder of the manuals' text; empty: the lock file speaks for it
  bool lock = false;    // write quotes.lock after the quotes were verified
};
int lint_command(const LintOptions& options, const harness::Protocols& protocols);

struct EmulateOptions {
  std::string model;     // "xbc-h?station=1&protocol=xgt-cnet"
  std::string tcp, udp;  // [HOST]:PORT, or HOST where the protocol has a port of its own
  std::string pty, tty;  // PATH
  std::string config;    // JSON file of keys of given.config
  std::string p2p;       // JSON file of P2P parameters: the device is the client
  std::string bus;       // [HOST]:PORT where a second device joins its fieldbus
  std::string monitor;   // CSV file of the frames that cross the line
  int control = -1;      // internal: the harness' back door
  bool verbose = false;
};
int emulate_command(const EmulateOptions& options, const harness::Protocols& protocols);

struct ProbeOptions {
  std::string endpoint;
  std::vector<std::string> stations, speeds, frames, protocols;  // empty: all that is usual
  int wait_ms = 500;                                             // for the first byte of an answer
  bool all = false;                                              // go on after the first find
  bool fingerprint = false;                                      // of each device that was found
  std::string profile;  // of a program that the bench starts: what its command is told; empty: the
                        // usual
};
/// What `probe` has found, to go on with.
struct ProbedDevice {
  std::string endpoint;  // with its settings, station and protocol
  std::string protocol;
  std::string profile;  // that suits a module of the protocol; of an emulator: its own
};
/// `found`, where it is not nullptr, takes each device.
int probe_command(const ProbeOptions& options, const harness::Protocols& protocols,
                  std::vector<ProbedDevice>* found = nullptr);

struct InitOptions {
  std::string endpoint, protocol, profile, name, serial, firmware, allow_write;
  std::string ci;                      // "github", "gitlab", "none"
  std::string bench = "bench.json";    // made, or added to
  std::string out = "fieldproof-out";  // of the first run
  bool yes = false;                    // nobody is asked
  bool no_run = false;
};
/// Finds a device, writes it into a bench file, runs its cases, and writes a job for CI.
int init_command(const InitOptions& options, const harness::Protocols& protocols);

struct FrameOptions {
  std::string frame;
  std::string protocol;  // empty: the one that the frame fits best
  int station = 1;
};
int frame_command(const FrameOptions& options, const harness::Protocols& protocols);

struct ErrataOptions {
  std::string vectors;
  bool json = false, markdown = false;
};
int errata_command(const ErrataOptions& options, const harness::Protocols& protocols);

struct ReportOptions {
  std::string ndjson, junit, json, html, capture, csv;
};
int report_command(const ReportOptions& options);

struct RestoreOptions {
  std::string journal;
  std::string endpoint;  // empty: the one that the journal names
};
int restore_command(const RestoreOptions& options, const harness::Protocols& protocols);

struct CompareOptions {
  std::vector<std::string> files;  // results: the first is what the others are compared with
  std::string html, junit;
  std::string history;  // for the file `last`; empty: the user's own
};
int compare_command(const CompareOptions& options);

struct HistoryOptions {
  std::string file;                  // empty: the user's own
  std::vector<std::string> results;  // add
  std::string run = "last";          // show: its number, or "last"
  std::string device;                // its name or a part of it; empty: by the command
  std::string by = "device";         // matrix: "device", "firmware"
  std::string filter;                // matrix: cases by id
  int last = -1;                     // runs or columns; 0: all; negative: as usual
  std::string html;                  // matrix, trend: empty: none
  bool json = false, markdown = false;
};
/// Errors of the results or of the file are usage, those of writing it trouble.
int history_add_command(const HistoryOptions& options);
int history_list_command(const HistoryOptions& options);
int history_show_command(const HistoryOptions& options);
int history_matrix_command(const HistoryOptions& options);
int history_trend_command(const HistoryOptions& options);

struct MergeOptions {
  std::vector<std::string> files;  // results.ndjson or results.json of the parts of one run
  std::string out = "fieldproof-merged";
  std::string junit, json, html;  // empty: in `out`
  std::string command;            // as typed, for reports
};
int merge_command(const MergeOptions& options);

struct JudgeOptions {
  std::string file;     // results.ndjson or results.json
  std::string profile;  // empty: the one it was recorded with
  std::string filter;
  std::string vectors;  // empty: the tool's own
  std::string waivers;
  std::string out = "fieldproof-judged";
  std::string junit, json, html;  // empty: in `out`
  bool strict = false, qualify = false, fail_on_marginal = false;
  double min_judged = 0;  // percent; 0: as it was recorded
  bool verbose = false;
  std::string command;  // as typed, for reports
};
int judge_command(const JudgeOptions& options, const harness::Protocols& protocols);

}  // namespace fieldproof::cli
