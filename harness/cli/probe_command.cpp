#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <charconv>
#include <filesystem>

#include "harness/bench/benches.hpp"
#include "harness/bench/files/profile.hpp"
#include "harness/cli/commands.hpp"
#include "harness/cli/probe_found.hpp"
#include "harness/cli/probe_network.hpp"
#include "harness/endpoints/kinds.hpp"
#include "harness/paths.hpp"
#include "harness/probe/conclusion.hpp"
#include "harness/probe/target.hpp"
#include "harness/run/run_report.hpp"
#include "harness/system/interrupt.hpp"
#include "harness/system/terminal.hpp"
#include "reports/text/fold.hpp"

namespace fieldproof::cli {

using endpoints::EndpointName;
using probe::Finding;

namespace {

using Texts = std::vector<std::string>;

/// A station number, or -1.
int station_number(std::string_view text) {
  int value = -1;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && rest == text.data() + text.size() && value <= 255 ? value : -1;
}

/// Adds "0-31" or "5" to `to`; false when it is neither.
bool read_stations(const std::string& text, std::vector<int>& to) {
  const std::size_t dash = text.find('-');
  const int first = station_number(text.substr(0, dash));
  const int last = dash == std::string::npos ? first : station_number(text.substr(dash + 1));
  if (first < 0 || last < first) return false;
  for (int station = first; station <= last; ++station)
    if (std::ranges::find(to, station) == to.end()) to.push_back(station);
  return true;
}

/// What an option names, or what the endpoint's own option `key` says; an emulator's options
/// describe the device.
Texts chosen(const Texts& option, const EndpointName& endpoint, const std::string& key) {
  if (!option.empty() || probe::is_emulator(endpoint)) return option;
  const std::string own = endpoint.option(key, "");
  return own.empty() ? Texts{} : Texts{own};
}

Result<probe::SearchSpace> space_of(const ProbeOptions& options, const EndpointName& endpoint,
                                    const harness::Protocols& protocols) {
  probe::SearchSpace space;
  for (const std::string& text : chosen(options.stations, endpoint, "station"))
    if (!read_stations(text, space.stations))
      return fail(fmt::format("cannot read station '{}': write 5, or 0-31, from 0 to 255", text));
  for (const std::string& text : chosen(options.speeds, endpoint, "baud")) {
    const Result<line::LineSettings> line = line::parse_line_settings(text);
    if (!line) return line.error();
    space.speeds.push_back(line->baud);
  }
  for (const std::string& text : chosen(options.frames, endpoint, "frame")) {
    const Result<line::LineSettings> line = line::parse_line_settings("9600-" + text);
    if (!line) return line.error();
    space.frames.push_back(*line);
  }
  for (const std::string& text : chosen(options.protocols, endpoint, "protocol")) {
    const Result<const harness::Protocol*> protocol = protocols.choose(text, "");
    if (!protocol) return protocol.error();
    if (!probe::can_be_searched(**protocol))
      return fail(fmt::format("cannot search by {}: {}", text,
                              (*protocol)->on_network()
                                  ? "it runs on a network; write tcp:HOST[:PORT]"
                                  : "it has no harmless request of its own"));
    space.protocols.push_back(*protocol);
  }
  space.settable = probe::has_line_settings(endpoint);
  if (!space.settable && !(options.speeds.empty() && options.frames.empty()))
    return fail(fmt::format(
        "cannot search speeds and frames of {}: there are none; leave --speed and --frame out",
        endpoint.kind));
  return space;
}

std::string duration_text(Duration duration) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(duration).count();
  if (seconds < 120) return fmt::format("{} s", seconds);
  return seconds < 7200 ? fmt::format("{} min", (seconds + 59) / 60)
                        : fmt::format("{:.1f} h", static_cast<double>(seconds) / 3600);
}

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// The search and its worst case, before it begins.
std::string head(const ProbeOptions& options, const probe::SearchSpace& all,
                 const std::vector<probe::Trial>& plan, Duration longest) {
  std::vector<std::string_view> names;
  for (const harness::Protocol* protocol : all.protocols) names.push_back(protocol->name());
  std::string line;
  if (all.settable)
    line = fmt::format("{} x {} x ", counted(all.speeds.size(), "speed"),
                       counted(all.frames.size(), "frame"));
  return fmt::format(
      "probing {}: {}{} x {}\n"
      "{}, the most likely first; at most {} when nothing answers. Only reads are sent, nothing is "
      "written.\n"
      "--station, --speed, --frame, --protocol narrow the search{}\n",
      options.endpoint, line, counted(all.stations.size(), "station"), fmt::join(names, ", "),
      counted(plan.size(), "question"), duration_text(longest),
      all.settable ? "" : "; this link has no speed and no frame of its own");
}

/// One moving line on a terminal, one line a step in a log; both on stderr.
class ProgressLine {
 public:
  ProgressLine(Duration each, bool settable)
      : each_(each), settable_(settable), terminal_(::isatty(STDERR_FILENO) != 0) {}

  void show(std::size_t done, std::size_t total, const probe::Observation& last) const {
    const std::string text =
        fmt::format("[{}/{}] {}: {}", done, total,
                    settable_ ? probe::to_string(last.trial) : probe::question_of(last.trial),
                    probe::to_string(last.diagnosis.symptom));
    if (!terminal_)
      fmt::print(stderr, "{}{}\n", text, last.diagnosis.echo ? " (echo)" : "");
    else
      fmt::print(
          stderr, "\r\x1b[K{}",
          text::cut(fmt::format("{}, at most {} left", text,
                                duration_text(each_ * static_cast<Duration::rep>(total - done))),
                    static_cast<std::size_t>(os::terminal_columns(STDERR_FILENO)) - 1));
    std::fflush(stderr);
  }
  void erase() const {
    if (terminal_) fmt::print(stderr, "\r\x1b[K");
  }

 private:
  Duration each_;  // the longest time of a question, on average
  bool settable_;
  bool terminal_;
};

void report(const std::vector<Finding>& findings, const EndpointName& endpoint, bool settable) {
  for (const Finding& finding : findings) {
    const bool where = finding.trial.protocol && settable;
    run::tell(fmt::format("{:<13} {}{}\n", probe::to_string(finding.kind),
                          where ? line::to_string(finding.trial.line) + ", " : "", finding.text));
    if (!finding.advice.empty())
      run::tell(fmt::format("{:<13} {}\n", "what to do", finding.advice));
    if (finding.kind != Finding::Kind::device) continue;
    if (settable)
      run::tell(fmt::format(
          "{:<13} one or two stop bits: they read the same, see the module's setting\n", ""));
    run::tell(fmt::format("{:<13} {}\n", "go on with",
                          probe_run_line(endpoint, finding.trial, settable)));
  }
}

int exit_code_of(const std::vector<Finding>& findings, bool was_interrupted) {
  if (was_interrupted) return run::exit_code::interrupted;
  return std::ranges::any_of(findings, &Finding::is_problem) ? run::exit_code::failed
                                                             : run::exit_code::ok;
}

}  // namespace

int probe_command(const ProbeOptions& options, const harness::Protocols& protocols,
                  std::vector<ProbedDevice>* found) {
  const Result<EndpointName> endpoint = endpoints::parse_endpoint(options.endpoint);
  if (!endpoint) return run::complain(endpoint.error().message, run::exit_code::usage);
  const Result<ServerSearch> servers = servers_to_probe(options, *endpoint, protocols);
  if (!servers) return run::complain(servers.error().message, run::exit_code::usage);
  if (!servers->wanted.empty())
    if (const int code = probe_servers(options, *endpoint, *servers, protocols, found);
        code != search_a_line)
      return code;
  Result<probe::SearchSpace> space = space_of(options, *endpoint, protocols);
  if (!space) return run::complain(space.error().message, run::exit_code::usage);
  probe::ProbeTiming timing;
  timing.wait = std::chrono::milliseconds(options.wait_ms);
  timing.late = std::max(timing.late, timing.wait);
  const Result<const harness::Protocol*> spoken = protocols.choose(
      endpoint->option("protocol", ""), probe::is_emulator(*endpoint) ? endpoint->target : "");
  if (!spoken)
    return run::complain("cannot open " + options.endpoint + ": " + spoken.error().message,
                         run::exit_code::usage);
  const harness::Protocol& first = space->protocols.empty() ? **spoken : *space->protocols.front();
  const probe::LineOpener port = probe::line_opener(*endpoint, first);
  const probe::LineOpener open = [&](const line::LineSettings& settings) {
    Result<std::unique_ptr<endpoints::Endpoint>> device = port(settings);
    if (device)
      if (const Status told = tell_what_to_be(**device, *endpoint, first, options.profile); !told)
        device = told.error();
    return device;
  };

  os::catch_interrupts();
  {
    const Result<std::unique_ptr<endpoints::Endpoint>> there =
        port(probe::make_plan(*space, protocols).front().line);
    if (!there) return run::complain(there.error().message, run::exit_code::trouble);
    const endpoints::Capabilities& link = (*there)->capabilities();
    if (endpoints::kind_of(*endpoint).local_port && !link.wire) space->settable = false;  // a pty
  }
  const std::vector<probe::Trial> plan = probe::make_plan(*space, protocols);
  Duration longest = probe::longest_time(plan, timing.wait);
  if (endpoints::kind_of(*endpoint).started_by_bench())
    longest += std::min(longest, timing.starting);
  longest += timing.listen;
  run::tell(fmt::format("{}", head(options, probe::filled(*space, protocols), plan, longest)));
  std::fflush(stdout);

  const ProgressLine progress(longest / static_cast<Duration::rep>(plan.size()), space->settable);
  // The prober goes with its port, which the fingerprint opens anew.
  const Result<probe::Search> search =
      probe::Prober(open, protocols, timing,
                    [&](std::size_t done, std::size_t total, const probe::Observation& last) {
                      progress.show(done, total, last);
                    })
          .run(plan, options.all);
  progress.erase();
  if (!search) return run::complain(search.error().message, run::exit_code::trouble);
  for (const std::string& refused : search->not_offered)
    run::tell(fmt::format("{:<13} {}\n", "not tried", refused));
  if (search->interrupted)
    run::tell(
        fmt::format("{:<13} after {} of {}\n", "interrupted", search->trials, plan.size() + 1));
  const std::vector<Finding> findings = probe::conclude(*search, timing);
  report(findings, *endpoint, space->settable);
  for (const Finding& finding : findings)
    if (found && finding.kind == Finding::Kind::device)
      found->push_back(probed_device(*endpoint, finding.trial, space->settable));
  for (const Finding& finding : findings)
    if (options.fingerprint && finding.kind == Finding::Kind::device && !search->interrupted)
      if (const int code =
              print_probed_fingerprint(*endpoint, finding.trial, space->settable, timing.wait);
          code != run::exit_code::ok)
        return code;
  return exit_code_of(findings, search->interrupted);
}

}  // namespace fieldproof::cli
