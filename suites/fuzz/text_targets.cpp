#include "suites/fuzz/text_targets.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <set>
#include <sstream>

#include "harness/cli/frame_text.hpp"
#include "harness/endpoints/endpoint.hpp"
#include "harness/run/exit_code.hpp"
#include "harness/run/line_matrix.hpp"
#include "harness/safety/fence.hpp"
#include "harness/system/unique_fd.hpp"
#include "src/base/duration.hpp"
#include "src/plc/frame_monitor.hpp"
#include "suites/command_line/command_line.hpp"
#include "suites/fuzz/chosen.hpp"
#include "suites/fuzz/rule.hpp"

namespace fieldproof::fuzz {

namespace {

/// While it lives, nothing that is printed is seen.
class Silence {
 public:
  Silence() {
    const os::UniqueFd nothing(::open("/dev/null", O_WRONLY | O_CLOEXEC));
    for (const int fd : {1, 2}) {
      kept_[fd - 1] = os::UniqueFd(::fcntl(fd, F_DUPFD_CLOEXEC, 3));
      ::dup2(nothing.get(), fd);
    }
  }
  ~Silence() {
    std::fflush(stdout);
    for (const int fd : {1, 2}) ::dup2(kept_[fd - 1].get(), fd);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  os::UniqueFd kept_[2];
};

/// What cannot be read says why.
template <typename R>
void expect_reason(const R& read) {
  rule(read || !read.error().message.empty(), "an error says what is wrong");
}

}  // namespace

void feed_command(ByteView input) {
  std::vector<std::string> words{"fieldproof"};
  std::istringstream lines(to_text(input));
  for (std::string line; std::getline(lines, line);) words.push_back(line.c_str());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int code = 0;
  {
    const Silence silence;
    code = suites::with_command(static_cast<int>(words.size()), argv.data(),
                                [](const suites::Command&) { return run::exit_code::ok; });
  }
  rule(code == run::exit_code::ok || code == run::exit_code::usage,
       "a command line is read, or refused");
}

std::vector<Bytes> good_commands() {
  std::vector<Bytes> all;
  for (const char* words :
       {"run\n--endpoint\ntcp:10.0.0.1:502?protocol=modbus-tcp\n--profile\nxbc-h\n--filter\n"
        "modbus_tcp/*:-*/timing/*\n--seed=7\n--repeat\n3\n-v",
        "run\n--bench\nFILE\n--dut\nA,B\n--strict\n--qualify\n--min-judged\n90%\n--max-failures\n5",
        "run\n--matrix\n38400,115200 x 8N1,8E1\n--duration\n8h\n--gtest_shuffle\n--fail-on\n"
        "marginal",
        "explore\n--protocol\nmodbus-rtu\n--seed\n7\n--requests\n20000",
        "list\n--coverage\n--min-coverage\n99.5\n--markdown",
        "lint\n--manuals\n.\n--lock",
        "emulate\nxbc-h?station=3\n--tcp\n127.0.0.1:2000\n--control\n-",
        "probe\nserial:/dev/ttyUSB0\n--station\n0-31,5\n--speed\n9600\n--wait\n200",
        "init\n--yes\n--endpoint\nemulator:xbc-h\n--no-run",
        "frame\n[ENQ st 'rSS']\n--station\n5",
        "history\nmatrix\n--by\nfirmware\n--last\n3\n--json",
        "history\nadd\nA\nB",
        "compare\nlast\nNEW\n--html\nF",
        "merge\nA\nB\n--out\nC",
        "judge\nA\n--profile\nxbc-h",
        "restore\nJ\n--endpoint\nexec:x",
        "report\nA\n--junit\nF",
        "errata\n--json",
        "completion\nbash",
        "man",
        "--version",
        "--help",
        "run\n--help",
        "__complete\nrun\n--prof",
        "__complete\nrun\n--profile\nx"})
    all.push_back(to_bytes(words));
  return all;
}

void feed_options(ByteView input) {
  const std::string text = to_text(input);
  expect_reason(endpoints::parse_endpoint(text));
  expect_reason(run::parse_line_matrix(text));
  expect_reason(line::parse_line_settings(text));
  expect_reason(parse_duration(text));
  safety::WriteFence fence;
  expect_reason(
      fence.allow(text, [](std::string_view word) { return suites::protocols().read_word(word); }));
  expect_reason(fence.allow_motion(text, 20));
}

std::vector<Bytes> good_options() {
  std::vector<Bytes> all;
  for (const char* text :
       {"serial:/dev/ttyUSB0?baud=38400&frame=8N1&rs485=1&station=1", "emulator:xbc-h?station=3",
        "tcp:192.0.2.7:2004?protocol=xgt-fenet", "udp:[::1]:2005", "rfc2217:host:7000?baud=9600",
        "exec:./plc {tty} --x=1?station=5", "pty:xbm-s", "38400,115200 x 8N1,8E1", "all",
        "all x 8N1", "38400-8N1", "20ms", "1.6c", "8h", "M100-M199,D0-D99,h1230-h12FF", "all,P,Q,U",
        "%MW100", "0x40064", "1,3-5"})
    all.push_back(to_bytes(text));
  return all;
}

void feed_monitor(ByteView input) {
  const plc::MonitoredFrame frame{.data = {input.begin(), input.end()}};
  rule(cli::read_monitor_text(plc::ascii_view(frame)) == frame.data,
       "what the monitor shows reads as the same bytes");
  plc::csv_row(frame, "0.001 s");
  for (const harness::Protocol* const protocol : suites::protocols()) {
    [[maybe_unused]] const auto read = cli::read_frame_text(to_text(input), protocol->fields_at(1));
  }
}

std::vector<Bytes> good_monitors() {
  std::set<Bytes> all;
  for (const vectors::Case& one : cases_of_vectors())
    for (const vectors::Step& step : one.steps)
      for (const Bytes& wire : wires_of(step))
        if (all.size() < 2000 && wire.size() < 200)
          all.insert(to_bytes(plc::ascii_view({.data = wire})));
  return {all.begin(), all.end()};
}

}  // namespace fieldproof::fuzz
