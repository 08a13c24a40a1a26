// The commands of the tool. Each takes its options as a value and returns the exit code of DESIGN's table.
#pragma once

#include <string>
#include <vector>

namespace fieldproof {

/// Exit codes, in order of precedence where several apply: usage, interrupted, trouble, failed, nothing, absent, ok.
namespace exit_code {
inline constexpr int ok = 0, failed = 1, usage = 2, trouble = 3, nothing = 4, absent = 77, interrupted = 130;
}

struct RunOptions {
  std::string endpoint;          // empty: of the bench file's device, else "emulator:"
  std::string profile;           // empty: by the endpoint
  std::string filter;
  std::string vectors;           // empty: the tool's own
  std::string out = "fieldproof-out";
  std::string junit, json, html; // empty: in `out`
  std::string capture;           // empty: none
  std::string bench, dut;        // bench file, and the device of it
  std::string waivers;
  std::string baseline;          // results of an earlier run, to compare with
  std::string power_cycle;
  std::string role;              // "client", "server"; empty: both
  std::string stimulus;          // what makes a device ask: a command, or "-": the program of exec:
  std::string aux;               // a second channel of the PLC under test
  std::vector<std::string> allow_write;
  std::vector<std::string> gtest_arguments;
  double floor_ms = 0;           // --floor: the adapter's own uncertainty
  int seed = -1;                 // >= 0: shuffled by it
  int repeat = 1;
  bool strict = false, qualify = false, fail_on_marginal = false;
  bool fail_fast = false, dry_run = false, verbose = false, skip_absent = false;
  std::string command;           // as typed, for reports
};
int run_command(const RunOptions& options);

struct ListOptions {
  std::string filter, vectors;
  std::string role;              // "client", "server"; empty: both
  bool coverage = false;         // statements instead of cases
  std::string results, html;     // with coverage: verdicts of a run; a report
  double min_coverage = 0;       // with coverage: percent of the statements
  bool json = false, markdown = false;
};
int list_command(const ListOptions& options);

struct LintOptions {
  std::string vectors;
  std::string manuals;           // folder of the manuals' text; empty: the lock file speaks for it
  bool lock = false;             // write quotes.lock after the quotes were verified
};
int lint_command(const LintOptions& options);

struct EmulateOptions {
  std::string model;             // "xbc-h?station=1&protocol=xgt-cnet"
  std::string tcp, pty;          // 127.0.0.1:PORT, PATH
  std::string p2p;               // JSON file of P2P parameters: the device is the client
  int control = -1;              // internal: the harness' back door
  std::string tty;               // internal: the slave that the harness made
  bool verbose = false;
};
int emulate_command(const EmulateOptions& options);

struct ProbeOptions {
  std::string endpoint;
  std::vector<std::string> stations, speeds, frames, protocols;  // empty: all that is usual
  int wait_ms = 500;             // for the first byte of an answer
  bool all = false;              // go on after the first find
};
int probe_command(const ProbeOptions& options);

struct FrameOptions {
  std::string frame;
  std::string protocol;          // empty: the one that the frame fits best
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

struct CompareOptions {
  std::vector<std::string> files;  // results: the first is what the others are compared with
  std::string html, junit;
};
int compare_command(const CompareOptions& options);

struct JudgeOptions {
  std::string file;              // results.ndjson or results.json
  std::string profile;           // empty: the one it was recorded with
  std::string filter;
  std::string vectors;           // empty: the tool's own
  std::string waivers;
  std::string out = "fieldproof-judged";
  std::string junit, json, html; // empty: in `out`
  bool strict = false, qualify = false, fail_on_marginal = false;
  bool verbose = false;
  std::string command;           // as typed, for reports
};
int judge_command(const JudgeOptions& options);

/// A word of a command line as a shell reads it: quoted where it must be.
std::string shell_word(const std::string& word);

/// Prints "fieldproof: MESSAGE" to stderr and returns `code`.
int complain(const std::string& message, int code);

}  // namespace fieldproof
