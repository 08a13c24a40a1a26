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
  std::string endpoint = "emulator:";
  std::string profile;           // empty: by the endpoint
  std::string filter;
  std::string vectors;           // empty: the tool's own
  std::string out = "fieldproof-out";
  std::string junit, json;       // empty: in `out`
  std::string waivers;
  std::string power_cycle;
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
  bool coverage = false, json = false;
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
  int control = -1;              // internal: the harness' back door
  std::string tty;               // internal: the slave that the harness made
  bool verbose = false;
};
int emulate_command(const EmulateOptions& options);

struct FrameOptions {
  std::string frame;
  std::string protocol = "xgt-cnet";
  int station = 1;
};
int frame_command(const FrameOptions& options);

struct ErrataOptions {
  std::string vectors;
  bool json = false;
};
int errata_command(const ErrataOptions& options);

struct ReportOptions {
  std::string ndjson, junit, json;
};
int report_command(const ReportOptions& options);

/// A word of a command line as a shell reads it: quoted where it must be.
std::string shell_word(const std::string& word);

/// Prints "fieldproof: MESSAGE" to stderr and returns `code`.
int complain(const std::string& message, int code);

}  // namespace fieldproof
