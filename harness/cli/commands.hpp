// The commands of the tool. Each takes its options as a value and returns the exit code of DESIGN's
// table.
#pragma once

#include <string>
#include <vector>

namespace fieldproof {

/// Exit codes, in order of precedence where several apply: usage, interrupted, trouble, failed,
/// nothing, absent, ok.
namespace exit_code {
inline constexpr int ok = 0, failed = 1, usage = 2, trouble = 3, nothing = 4, absent = 77,
                     interrupted = 130;
}

struct RunOptions {
  std::string endpoint;  // empty: of the bench file's device, else "emulator:"
  std::string profile;   // empty: by the endpoint
  std::string filter;
  std::string vectors;  // empty: the tool's own
  std::string out = "fieldproof-out";
  std::string junit, json, html;  // empty: in `out`
  std::string capture;            // empty: none
  std::string bench;              // bench file
  std::vector<std::string> duts;  // devices of it; several share the cases
  std::string journal;            // empty: in `out`
  bool discard_journal = false;   // forget what an earlier run did not put back
  std::string waivers;
  std::string baseline;  // results of an earlier run, to compare with
  std::string power_cycle;
  std::string role;      // "client", "server"; empty: both
  std::string stimulus;  // what makes a device ask: a command, or "-": the program of exec:
  std::string aux;       // a second channel of the PLC under test
  std::vector<std::string> allow_write;
  std::vector<std::string> gtest_arguments;
  std::string floor;        // the link's own uncertainty: "2ms"; empty: measured
  std::string loop;         // endpoint with an emulator behind it, to measure the link with
  std::string matrix;       // line settings to repeat the cases with: "38400 x 8N1,8E1"
  std::string reconfigure;  // command that sets the device for a step of the matrix; empty: the
                            // engineer does
  std::string duration;     // soak: "8h"
  int seed = -1;            // >= 0: shuffled by it
  int repeat = 1;
  bool strict = false, qualify = false, fail_on_marginal = false;
  bool fail_fast = false, dry_run = false, verbose = false, skip_absent = false;
  std::string command;  // as typed, for reports
};
int run_command(const RunOptions& options);

struct ListOptions {
  std::string filter, vectors;
  std::string role;           // "client", "server"; empty: both
  bool coverage = false;      // statements instead of cases
  std::string results, html;  // with coverage: verdicts of a run; a report
  double min_coverage = 0;    // with coverage: percent of the statements
  bool json = false, markdown = false;
};
int list_command(const ListOptions& options);

struct LintOptions {
  std::string vectors;
  std::string manuals;  // folder of the manuals' text; empty: the lock file speaks for it
  bool lock = false;    // write quotes.lock after the quotes were verified
};
int lint_command(const LintOptions& options);

struct EmulateOptions {
  std::string model;     // "xbc-h?station=1&protocol=xgt-cnet"
  std::string tcp, pty;  // 127.0.0.1:PORT, PATH
  std::string p2p;       // JSON file of P2P parameters: the device is the client
  std::string monitor;   // CSV file of the frames that cross the line
  int control = -1;      // internal: the harness' back door
  std::string tty;       // internal: the slave that the harness made
  bool verbose = false;
};
int emulate_command(const EmulateOptions& options);

struct ProbeOptions {
  std::string endpoint;
  std::vector<std::string> stations, speeds, frames, protocols;  // empty: all that is usual
  int wait_ms = 500;                                             // for the first byte of an answer
  bool all = false;                                              // go on after the first find
  bool fingerprint = false;                                      // of each device that was found
};
int probe_command(const ProbeOptions& options);

struct FrameOptions {
  std::string frame;
  std::string protocol;  // empty: the one that the frame fits best
  int station = 1;
};
int frame_command(const FrameOptions& options);

struct ErrataOptions {
  std::string vectors;
  bool json = false, markdown = false;
};
int errata_command(const ErrataOptions& options);

struct ReportOptions {
  std::string ndjson, junit, json, html, capture;
};
int report_command(const ReportOptions& options);

struct RestoreOptions {
  std::string journal;
  std::string endpoint;  // empty: the one that the journal names
};
int restore_command(const RestoreOptions& options);

struct CompareOptions {
  std::vector<std::string> files;  // results: the first is what the others are compared with
  std::string html, junit;
};
int compare_command(const CompareOptions& options);

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
  bool verbose = false;
  std::string command;  // as typed, for reports
};
int judge_command(const JudgeOptions& options);

/// A word of a command line as a shell reads it: quoted where it must be.
std::string shell_word(const std::string& word);

/// Prints "fieldproof: MESSAGE" to stderr and returns `code`.
int complain(const std::string& message, int code);

}  // namespace fieldproof
