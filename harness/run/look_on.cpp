#include "harness/run/look_on.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

#include "harness/endpoints/forwarding.hpp"
#include "harness/endpoints/options.hpp"
#include "harness/probe/conclusion.hpp"
#include "harness/probe/prober.hpp"

namespace fieldproof::run {

using harness::Protocol;
using probe::Finding;
using probe::Trial;

namespace {

constexpr int last_usual_station = 31;

/// With the three questions that confirm a find, it is over within 3 s. A device that answers later
/// than `wait` is known by its station, and asked again.
constexpr probe::ProbeTiming look_timing{
    .wait = 30ms, .late = 250ms, .quiet = 50ms, .listen = 60ms, .budget = 2s};

/// The digits of `number` in base `from`, read in base `to`; nothing where they cannot be.
std::optional<int> reread(int number, int from, int to) {
  char digits[8];
  const auto written = std::to_chars(std::begin(digits), std::end(digits), number, from);
  int value = -1;
  const auto [rest, error] = std::from_chars(digits, written.ptr, value, to);
  if (error != std::errc{} || rest != written.ptr || value > 255 || value == number)
    return std::nullopt;
  return value;
}

std::string also(const std::string& text) { return text.empty() ? "" : "; " + text; }

std::string what_was_asked(const probe::Search& search) {
  std::vector<std::string> parts;
  std::vector<const Protocol*> named;
  for (const Trial& one : search.asked) {
    if (std::ranges::find(named, one.protocol) != named.end()) continue;
    named.push_back(one.protocol);
    std::vector<int> stations;
    for (const Trial& other : search.asked)
      if (other.protocol == one.protocol) stations.push_back(other.station);
    parts.push_back(fmt::format("{} at station{} {}", one.protocol->name(),
                                stations.size() == 1 ? "" : "s", ranges_of(stations)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// What to write so that the run asks whoever was found.
std::string what_to_write(const Trial& found, const exchange::Channel& asked) {
  const bool other_protocol = found.protocol->name() != asked.protocol->name();
  std::string text;
  if (other_protocol)
    text = fmt::format(
        "write protocol={0}{1} behind the '?' of the endpoint (or --protocol {0})",
        found.protocol->name(),
        found.station == asked.station ? "" : fmt::format("&station={}", found.station));
  else if (found.station != asked.station)
    text = fmt::format("write station={} behind the '?' of the endpoint", found.station);
  else
    return "it answers now: run again";
  if (found.station == asked.station) return text;
  text += fmt::format(", or \"config\": {{\"station\": {}}} in the profile", found.station);
  if (reread(asked.station, 10, 16) == found.station)
    text += fmt::format("; {} is {} hex: stations are written in decimal", found.station,
                        asked.station);
  else if (reread(asked.station, 16, 10) == found.station)
    text += fmt::format("; {} is {} hex: is the device's number hex, or decimal?", asked.station,
                        found.station);
  return text;
}

std::string said_of(const Finding& finding, const exchange::Channel& asked) {
  if (finding.kind == Finding::Kind::device)
    return finding.text + "; " + what_to_write(finding.trial, asked);
  return fmt::format("{}: {}{}", probe::to_string(finding.kind), finding.text,
                     also(finding.advice));
}

line::LineSettings line_of(const endpoints::EndpointName& name) {
  const Result<endpoints::SerialOptions> options = endpoints::serial_options(name);
  return options ? options->settings : line::LineSettings{};
}

Result<probe::Search> search(const exchange::Channel& asked, const DutPlan& plan) {
  std::vector<const Protocol*> others;
  for (const std::string& name : plan.bench.profile.protocols)
    if (const Protocol* one = plan.known.find(name);
        one && one->name() != asked.protocol->name() && probe::can_be_searched(*one))
      others.push_back(one);
  const probe::LineOpener open =
      [&](const line::LineSettings&) -> Result<std::unique_ptr<endpoints::Endpoint>> {
    return std::unique_ptr<endpoints::Endpoint>(
        std::make_unique<endpoints::Forwarding>(*asked.endpoint));
  };
  const auto quietly = [](std::size_t, std::size_t, const probe::Observation&) {};
  return probe::Prober(open, plan.known, look_timing, quietly)
      .run(trials_instead_of(*plan.known.find(asked.protocol->name()), asked.station, others,
                             line_of(plan.endpoint)),
           false);
}

}  // namespace

std::string ranges_of(std::vector<int> numbers) {
  std::ranges::sort(numbers);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    parts.push_back(last == i ? fmt::format("{}", numbers[i])
                              : fmt::format("{} to {}", numbers[i], numbers[last]));
    i = last + 1;
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<Trial> trials_instead_of(const Protocol& asked, int station,
                                     const std::vector<const Protocol*>& others,
                                     const line::LineSettings& line) {
  std::vector<Trial> plan;
  const auto add = [&](const Protocol& protocol, int number) {
    const Trial trial{line, &protocol, number};
    if ((&protocol != &asked || number != station) && std::ranges::find(plan, trial) == plan.end())
      plan.push_back(trial);
  };
  const auto add_all = [&](int number) {
    add(asked, number);
    for (const Protocol* other : others) add(*other, number);
  };
  for (const auto other : {reread(station, 10, 16), reread(station, 16, 10)})
    if (other) add(asked, *other);
  add_all(station);
  for (const int number : {1, 0, 2, 3}) add_all(number);
  for (int number = 4; number <= last_usual_station; ++number) add(asked, number);
  for (int number = 4; number <= last_usual_station; ++number) add_all(number);
  return plan;
}

Error looked_on(Error why, const bench::Benches& port, const DutPlan& plan) {
  const std::optional<exchange::Channel> asked = port.silent_line();
  if (!asked || why.interrupted || !plan.known.find(asked->protocol->name()) ||
      !probe::can_be_searched(*asked->protocol))
    return why;
  const Result<probe::Search> found = search(*asked, plan);
  if (!found) return found.error();
  if (found->interrupted) return Error{"interrupted", true};
  std::string said;
  const std::vector<Finding> findings = probe::conclude(*found, look_timing);
  for (const Finding& one : findings)
    if (one.kind != Finding::Kind::silence) said += also(said_of(one, *asked));
  if (said.empty())
    why.message += "; nor does anything else there: asked " + what_was_asked(*found);
  else if (findings.front().kind == Finding::Kind::device)
    why.message =
        fmt::format("nothing answers on {} at station {} by {}; but{}", asked->endpoint->describe(),
                    asked->station, asked->protocol->name(), said.substr(1));
  else
    why.message += said;
  return why;
}

}  // namespace fieldproof::run
