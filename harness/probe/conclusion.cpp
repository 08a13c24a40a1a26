#include "harness/probe/conclusion.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <functional>
#include <set>

namespace fieldproof::probe {

namespace {

using Kind = Finding::Kind;
using Observations = std::vector<const Observation*>;

Observations those(const Search& search, const std::function<bool(const Observation&)>& wanted) {
  Observations found;
  for (const Observation& one : search.observations)
    if (wanted(one)) found.push_back(&one);
  return found;
}

bool is_reply(const Observation& one) {
  return one.diagnosis.symptom == Symptom::reply || one.diagnosis.symptom == Symptom::second_reply;
}

auto with(Symptom symptom) {
  return
      [symptom](const Observation& one) { return one.diagnosis.symptom == symptom && !one.late; };
}

constexpr const char* echo_text = "our own question comes back";
constexpr const char* echo_advice =
    "a two-wire RS-485 line hears itself: set the adapter to two-wire mode without echo (rs485=1, "
    "or rs485=rts), "
    "and the module to RS-485, not RS-422 (Cnet EN 11.2.4); see also that TX and RX are not "
    "joined; "
    "echo=on behind the '?' of the endpoint takes the echo out";
constexpr const char* two_devices_advice =
    "two devices have this station number: disconnect one, or give it another number (Cnet EN "
    "11.2.5)";

std::string times_of(const Observations& replies) {
  Duration fastest = Duration::max(), slowest{};
  for (const Observation* one : replies) {
    const Duration time = one->diagnosis.response_time.value_or(Duration::zero());
    fastest = std::min(fastest, time);
    slowest = std::max(slowest, time);
  }
  if (slowest - fastest < 100us) return fmt::format("{:.1f} ms", to_ms(slowest));
  return fmt::format("{:.1f} to {:.1f} ms", to_ms(fastest), to_ms(slowest));
}

Finding answers_for_others(const Observations& seen) {
  const Observation& first = *seen.front();
  return {Kind::other_station, first.trial,
          fmt::format("station {} answers where station {} was asked: {}", first.diagnosis.station,
                      first.trial.station, shown(first.diagnosis.frame)),
          "a gateway, or a device that answers for every station: correct its setting, or keep it "
          "alone on the line"};
}

/// A device, and what is wrong around its replies.
void add_device(const Search& search, const Trial& trial, std::vector<Finding>& findings) {
  constexpr std::size_t asked = 3;
  const Observations replies =
      those(search, [&](const Observation& one) { return one.trial == trial && is_reply(one); });
  const Diagnosis& first = replies.front()->diagnosis;
  const std::string text = fmt::format("{}, station {}, answers in {}: {}", trial.protocol->name(),
                                       trial.station, times_of(replies), shown(first.frame));
  findings.push_back({Kind::device, trial, text, ""});
  const auto any = [&](const std::function<bool(const Diagnosis&)>& wrong) {
    return std::ranges::any_of(replies,
                               [&](const Observation* one) { return wrong(one->diagnosis); });
  };
  if (any(&Diagnosis::echo))
    findings.push_back(
        {Kind::echo, trial, std::string(echo_text) + " before the reply", echo_advice});
  if (any([](const Diagnosis& d) { return d.symptom == Symptom::second_reply; }))
    findings.push_back(
        {Kind::two_devices, trial, "two replies come to one question", two_devices_advice});
  if (any([](const Diagnosis& d) { return d.stray > 0; }))
    findings.push_back({Kind::stray_bytes, trial,
                        "bytes that belong to no frame come with the reply",
                        "the idle line floats while the direction changes: fit bias (fail-safe) "
                        "and terminating resistors, connect the ground"});
  const Observations for_others = those(search, [&](const Observation& one) {
    return with(Symptom::other_station)(one) && one.trial.line == trial.line &&
           one.diagnosis.station == trial.station;
  });
  if (!for_others.empty()) findings.push_back(answers_for_others(for_others));
  if (replies.size() < asked)
    findings.push_back(
        {Kind::unstable, trial,
         fmt::format("only {} of {} questions are answered right", replies.size(), asked),
         "the line is disturbed, or somebody else talks: check shield, ground, termination and "
         "other masters (Cnet EN 11.2.5)"});
}

/// "142 bytes and 3 framing errors at 5 settings, as 00 FF FF"
std::string amount(const Observations& observations) {
  std::set<std::string> settings, errors;
  std::size_t bytes = 0;
  ByteView sample;
  for (const Observation* one : observations) {
    settings.insert(line::to_string(one->trial.line));
    if (!one->heard.errors.empty()) errors.insert(one->heard.errors);
    bytes += one->diagnosis.frame.size();
    if (sample.empty()) sample = one->diagnosis.frame;
  }
  std::string text = fmt::format("{} byte{}", bytes, bytes == 1 ? "" : "s");
  if (!sample.empty()) text += fmt::format(" (such as {})", shown(sample));
  if (!errors.empty()) text += fmt::format(", line errors (such as {})", *errors.begin());
  return fmt::format("{} at {} setting{}", text, settings.size(), settings.size() == 1 ? "" : "s");
}

/// What the garbage looks like.
std::string character_of(const Observations& garbage) {
  std::size_t all = 0, runs = 0;
  bool inverted = false, breaks = false;
  for (const Observation* one : garbage) {
    inverted = inverted || one->diagnosis.symptom == Symptom::inverted;
    breaks = breaks || one->heard.errors.find("break") != std::string::npos;
    const Bytes& bytes = one->diagnosis.frame;
    all += bytes.size();
    runs += static_cast<std::size_t>(
        std::ranges::count_if(bytes, [](Byte b) { return b == 0x00 || b == 0xFF; }));
  }
  if (inverted) return "; with all bits inverted it is a frame: A and B are swapped";
  if (breaks)
    return "; the line stands at break: A and B are swapped, or nothing holds the idle line";
  if (all > 0 && runs * 2 >= all)
    return "; mostly 00 and FF, as a swapped pair or a line without bias gives";
  return "";
}

std::string frame_of(const Observations& seen) { return shown(seen.front()->diagnosis.frame); }

/// Without a device: what else was heard, the surest first.
void add_troubles(const Search& search, std::vector<Finding>& findings) {
  const auto add = [&](Kind kind, const Observations& seen, std::string text, std::string advice) {
    findings.push_back({kind, seen.front()->trial, std::move(text), std::move(advice)});
  };
  if (const auto seen = those(search, with(Symptom::damaged)); !seen.empty())
    add(Kind::two_devices, seen,
        fmt::format("a reply begins as it should, then goes wrong ({} time{}): {}", seen.size(),
                    seen.size() == 1 ? "" : "s", frame_of(seen)),
        "two devices with one station number answer at once, or the line is disturbed: connect one "
        "device alone; "
        "check termination and ground (Cnet EN 11.2.5)");
  if (const auto seen = those(search, with(Symptom::other_station)); !seen.empty())
    findings.push_back(answers_for_others(seen));
  if (const auto seen = those(search, with(Symptom::foreign_frame)); !seen.empty()) {
    const Diagnosis& first = seen.front()->diagnosis;
    add(Kind::other_talker, seen,
        fmt::format("a {} frame of station {} that answers nothing we asked: {}",
                    first.protocol->name(), first.station, frame_of(seen)),
        "another master asks on this line, or the device itself is set as client (P2P): disconnect "
        "the master, "
        "or set the module as server (Cnet EN table 4.3.3)");
  }
  if (const auto seen = those(search, &Observation::late); !seen.empty())
    add(Kind::unstable, seen,
        fmt::format("station {} has answered late, and not again: {}",
                    seen.front()->diagnosis.station, frame_of(seen)),
        "give --wait more time, and see that the line is not disturbed");
  // A format that was tried then, and did not bring a reply, was none.
  const auto untried = [&](const Observation& one) {
    return one.diagnosis.right_format &&
           std::ranges::find(search.lines, *one.diagnosis.right_format) == search.lines.end();
  };
  if (const auto seen = those(search, untried); !seen.empty())
    add(Kind::format, seen,
        fmt::format("the device answers with another character format: {} is read, {} is right: {}",
                    line::to_string(seen.front()->trial.line),
                    line::to_string(*seen.front()->diagnosis.right_format), frame_of(seen)),
        "give both sides the same data bits and parity (Cnet EN 11.2.5)");
  const bool named = !findings.empty();
  if (const auto seen = those(search, [](const Observation& one) { return one.diagnosis.echo; });
      !seen.empty())
    add(Kind::echo, seen, fmt::format("{}, and nothing else", echo_text), echo_advice);
  const auto garbage = those(search, [](const Observation& one) {
    const Symptom symptom = one.diagnosis.symptom;
    return symptom == Symptom::garbage || symptom == Symptom::inverted ||
           symptom == Symptom::format;
  });
  if (!named && !garbage.empty())
    add(Kind::wiring, garbage, "garbage: " + amount(garbage) + character_of(garbage),
        "swap A and B; fit bias and terminating resistors, connect the ground; or the speed is "
        "none of those that were tried");
}

}  // namespace

std::string_view to_string(Kind kind) {
  switch (kind) {
    case Kind::device: return "found";
    case Kind::echo: return "echo";
    case Kind::two_devices: return "two devices";
    case Kind::stray_bytes: return "stray bytes";
    case Kind::unstable: return "unstable";
    case Kind::other_station: return "other station";
    case Kind::other_talker: return "other talker";
    case Kind::format: return "wrong format";
    case Kind::wiring: return "wiring";
    case Kind::silence: return "silence";
  }
  return "";
}

std::vector<Finding> conclude(const Search& search, const ProbeTiming& timing) {
  std::vector<Finding> findings;
  std::vector<Trial> devices;
  for (const Observation& one : search.observations)
    if (is_reply(one) && std::ranges::find(devices, one.trial) == devices.end())
      devices.push_back(one.trial);
  for (const Trial& device : devices) add_device(search, device, findings);
  if (devices.empty()) add_troubles(search, findings);
  if (findings.empty())
    findings.push_back(
        {Kind::silence,
         {},
         fmt::format("nothing on the line: {} trials, not a byte and not an error", search.trials),
         fmt::format(
             "see that the device is on and is set as server, that TX meets RX and A meets A; "
             "a device that answers later than {:g} ms wants --wait, a station beyond those tried "
             "--station",
             to_ms(timing.wait))});
  return findings;
}

}  // namespace fieldproof::probe
