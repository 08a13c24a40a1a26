#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <algorithm>
#include <charconv>

#include "harness/bench/benches.hpp"
#include "harness/cli/commands.hpp"
#include "harness/probe/conclusion.hpp"
#include "harness/probe/target.hpp"
#include "harness/system/interrupt.hpp"

namespace fieldproof {

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
  if (!option.empty() || is_emulator(endpoint)) return option;
  const std::string own = endpoint.option(key, "");
  return own.empty() ? Texts{} : Texts{own};
}

Result<SearchSpace> space_of(const ProbeOptions& options, const EndpointName& endpoint,
                             const Protocols& protocols) {
  SearchSpace space;
  for (const std::string& text : chosen(options.stations, endpoint, "station"))
    if (!read_stations(text, space.stations))
      return fail(fmt::format("cannot read station '{}': write 5, or 0-31, from 0 to 255", text));
  for (const std::string& text : chosen(options.speeds, endpoint, "baud")) {
    const Result<LineSettings> line = parse_line_settings(text);
    if (!line) return line.error();
    space.speeds.push_back(line->baud);
  }
  for (const std::string& text : chosen(options.frames, endpoint, "frame")) {
    const Result<LineSettings> line = parse_line_settings("9600-" + text);
    if (!line) return line.error();
    space.frames.push_back(*line);
  }
  for (const std::string& text : chosen(options.protocols, endpoint, "protocol")) {
    const Result<const Protocol*> protocol = protocols.choose(text, "");
    if (!protocol) return protocol.error();
    if ((*protocol)->probe(1, {}).empty())
      return fail(fmt::format("cannot search by {}: it has no harmless request of its own", text));
    space.protocols.push_back(*protocol);
  }
  space.settable = has_line_settings(endpoint);
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
std::string head(const ProbeOptions& options, const SearchSpace& all,
                 const std::vector<Trial>& plan, Duration longest) {
  std::vector<std::string_view> names;
  for (const Protocol* protocol : all.protocols) names.push_back(protocol->name());
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

  void show(std::size_t done, std::size_t total, const Observation& last) const {
    const std::string text = fmt::format(
        "[{}/{}] {}: {}", done, total, settable_ ? to_string(last.trial) : question_of(last.trial),
        to_string(last.diagnosis.symptom));
    if (!terminal_)
      fmt::print(stderr, "{}{}\n", text, last.diagnosis.echo ? " (echo)" : "");
    else
      fmt::print(stderr, "\r\x1b[K{}, at most {} left", text,
                 duration_text(each_ * static_cast<Duration::rep>(total - done)));
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

/// Its own module's profile is for the engineer to choose; this one exists and binds nothing that
/// the manuals leave open.
std::string run_line(const EndpointName& endpoint, const Finding& device, bool settable) {
  std::string line = "fieldproof run --endpoint " +
                     shell_word(to_string(name_of_found(endpoint, device.trial, settable)));
  if (is_emulator(endpoint)) return line;
  const std::vector<std::string> models = device.trial.protocol->models();
  return line + " --profile " +
         (std::ranges::count(models, "xbc-h") > 0 ? "xbc-dxxxh" : models.front());
}

/// Of a device that was found; what went wrong is said and makes the exit code.
int print_fingerprint(const EndpointName& endpoint, const Trial& device, bool settable,
                      Duration patience) {
  EndpointName name = name_of_found(endpoint, device, settable);
  name.options["protocol"] = device.protocol->name();
  BenchOptions options;
  options.station = device.station;
  options.profile.response_max = patience;
  Result<Benches> port = Benches::open(name, {device.protocol}, options);
  if (!port) return complain(port.error().message, exit_code::trouble);
  const Result<Fingerprint> found = port->fingerprint();
  if (!found)
    return complain(found.error().message,
                    found.error().interrupted ? exit_code::interrupted : exit_code::trouble);
  fmt::print("{:<13} {}\n", "fingerprint", to_string(*found));
  return exit_code::ok;
}

void report(const std::vector<Finding>& findings, const EndpointName& endpoint, bool settable) {
  for (const Finding& finding : findings) {
    const bool where = finding.trial.protocol && settable;
    fmt::print("{:<13} {}{}\n", to_string(finding.kind),
               where ? to_string(finding.trial.line) + ", " : "", finding.text);
    if (!finding.advice.empty()) fmt::print("{:<13} {}\n", "what to do", finding.advice);
    if (finding.kind != Finding::Kind::device) continue;
    if (settable)
      fmt::print("{:<13} one or two stop bits: they read the same, see the module's setting\n", "");
    fmt::print("{:<13} {}\n", "go on with", run_line(endpoint, finding, settable));
  }
}

int exit_code_of(const std::vector<Finding>& findings, bool was_interrupted) {
  if (was_interrupted) return exit_code::interrupted;
  return std::ranges::any_of(findings, &Finding::is_problem) ? exit_code::failed : exit_code::ok;
}

}  // namespace

int probe_command(const ProbeOptions& options, const Protocols& protocols) {
  const Result<EndpointName> endpoint = parse_endpoint(options.endpoint);
  if (!endpoint) return complain(endpoint.error().message, exit_code::usage);
  Result<SearchSpace> space = space_of(options, *endpoint, protocols);
  if (!space) return complain(space.error().message, exit_code::usage);
  ProbeTiming timing;
  timing.wait = std::chrono::milliseconds(options.wait_ms);
  timing.late = std::max(timing.late, timing.wait);
  const Result<const Protocol*> spoken = protocols.choose(
      endpoint->option("protocol", ""), is_emulator(*endpoint) ? endpoint->target : "");
  if (!spoken)
    return complain("cannot open " + options.endpoint + ": " + spoken.error().message,
                    exit_code::usage);
  const LineOpener open = line_opener(*endpoint, **spoken);

  catch_interrupts();
  {
    const Result<std::unique_ptr<Endpoint>> first = open(make_plan(*space, protocols).front().line);
    if (!first) return complain(first.error().message, exit_code::trouble);
    const Capabilities& link = (*first)->capabilities();
    if (endpoint->kind == "serial" && !link.wire) space->settable = false;  // a pty
  }
  const std::vector<Trial> plan = make_plan(*space, protocols);
  const Duration longest = longest_time(plan, timing.wait) + timing.listen;
  fmt::print("{}", head(options, filled(*space, protocols), plan, longest));
  std::fflush(stdout);

  const ProgressLine progress(longest / static_cast<Duration::rep>(plan.size()), space->settable);
  Prober prober(open, protocols, timing,
                [&](std::size_t done, std::size_t total, const Observation& last) {
                  progress.show(done, total, last);
                });
  const Result<Search> search = prober.run(plan, options.all);
  progress.erase();
  if (!search) return complain(search.error().message, exit_code::trouble);
  for (const std::string& refused : search->not_offered)
    fmt::print("{:<13} {}\n", "not tried", refused);
  if (search->interrupted)
    fmt::print("{:<13} after {} of {}\n", "interrupted", search->trials, plan.size() + 1);
  const std::vector<Finding> findings = conclude(*search, timing);
  report(findings, *endpoint, space->settable);
  for (const Finding& finding : findings)
    if (options.fingerprint && finding.kind == Finding::Kind::device && !search->interrupted)
      if (const int code =
              print_fingerprint(*endpoint, finding.trial, space->settable, timing.wait);
          code != exit_code::ok)
        return code;
  return exit_code_of(findings, search->interrupted);
}

}  // namespace fieldproof
