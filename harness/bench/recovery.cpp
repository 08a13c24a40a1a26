#include "harness/bench/recovery.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "harness/notation/notation.hpp"
#include "harness/system/hook.hpp"

namespace fieldproof::bench {

using exchange::PreparedCase;
using results::CaseResult;
using results::Verdict;

namespace {

constexpr Duration revive_patience = 10s;

}  // namespace

/// The program under test has ended in the middle of a case that waits for its requests. It is
/// started again, so that the others are judged.
bool Recovery::gave_up(const PreparedCase& prepared, const Error& trouble, CaseResult& result) {
  if (!prepared.is_client() || !options_.endpoint_is_stimulus || trouble.interrupted) return false;
  result.verdict = Verdict::fail;
  result.message = "the client gave up: " + trouble.message;
  known_.client_gave_up = true;
  if (!arming_.revive()) stop("the client gave up too often, last in " + result.id);
  return true;
}

void Recovery::after(const PreparedCase& prepared, const exchange::Transcript& transcript,
                     CaseResult& result) {
  if (transcript.trouble && gave_up(prepared, *transcript.trouble, result)) return;
  if (transcript.trouble)
    return stop("the port failed in " + result.id + ": " + transcript.trouble->message,
                &*transcript.trouble);
  bool dead = !transcript.dead.empty();
  // In simulated time the sanity exchange after a negative case is made here; in real time closing
  // the case was one.
  const bool negative = prepared.listens_for_silence() || result.verdict == Verdict::fail;
  if (endpoint_.capabilities().simulated && negative && prepared.answers_probes()) {
    const Result<exchange::Sign> alive = exchange_.anything_answers(
        prepared.station, 3 * options_.profile.response_max, prepared.reply_delay);
    if (!alive)
      return stop("the port failed after " + result.id + ": " + alive.error().message,
                  &alive.error());
    dead = *alive != exchange::Sign::alive;
    if (dead) result.recording.dead = "nothing answers any more";
    if (dead && result.verdict != Verdict::fail) {
      result.verdict = Verdict::fail;
      result.message = "link dead after this frame: nothing answers any more";
    }
  }
  // Emulators become a fresh device with the next case.
  if (dead && endpoint_.capabilities().real_device) revive(result, prepared.listens_for_silence());
}

bool Recovery::look_for_device(CaseResult& result, const std::string& what) {
  const Result<exchange::Sign> alive =
      exchange_.anything_answers(options_.station, 3 * options_.profile.response_max);
  if (!alive) {
    result.verdict = Verdict::error;
    result.message = alive.error().message;
    stop("the port failed in " + result.id + ": " + result.message, &alive.error());
    return false;
  }
  if (*alive == exchange::Sign::alive) return true;
  const std::string dead = what + "; " + exchange::why_dead(*alive);
  if (result.verdict == Verdict::fail)
    result.notes.push_back(dead);
  else
    result.message = dead;
  result.verdict = Verdict::fail;
  revive(result);
  return false;
}

void Recovery::start_again(CaseResult& result) {
  if (!endpoint_.capabilities().real_device || !endpoint_.capabilities().can_power_cycle ||
      !options_.power_cycle_command.empty() || options_.endpoint_is_stimulus ||
      options_.max_restarts == 0)
    return;
  const Bytes last = endpoint_.last_sent();
  const bool of_case = std::ranges::any_of(result.exchange, [&](const results::Event& event) {
    return event.kind == results::Event::Kind::sent && event.bytes == last;
  });
  result.message =
      fmt::format("the device ended {}{}: {}", of_case ? "" : "while its memory was read or set, ",
                  last.empty() ? "before it was asked" : "after " + notation::print_bytes(last),
                  known_.stopped);
  result.verdict = Verdict::fail;
  known_.stopped.clear();
  known_.port_failed = false;
  revive(result, true);
}

void Recovery::revive(CaseResult& result, bool odd) {
  if (endpoint_.capabilities().can_power_cycle || !options_.power_cycle_command.empty())
    if (std::string enough = known_.worth_asking.restart(result, odd); !enough.empty())
      return stop(std::move(enough));
  if (!power_cycle(result))
    stop(fmt::format(
        "the link is dead since {}; power-cycle the device, or give --power-cycle COMMAND",
        result.id));
}

bool Recovery::power_cycle(CaseResult& result, bool client) {
  const bool hook = !options_.power_cycle_command.empty();
  if (hook && !os::run_hook(options_.power_cycle_command, {}, {})) {
    result.notes.push_back("the --power-cycle command failed");
    return false;
  }
  const endpoints::Capabilities& can = endpoint_.capabilities();
  if (!hook && !((can.can_power_cycle || can.control) && endpoint_.act("power_cycle")))
    return false;
  known_.starts = endpoint_.starts();
  result.notes.push_back("power-cycled the device");
  if (client) return arming_.started_anew();  // it answers no probe
  const Result<exchange::Sign> sign =
      exchange_.anything_answers(options_.station, revive_patience, {}, true);
  return sign && *sign == exchange::Sign::alive;
}

void Recovery::stop(std::string why, const Error* error) {
  known_.stopped = std::move(why);
  known_.port_failed = error != nullptr;
  known_.interrupted = error && error->interrupted;
}

}  // namespace fieldproof::bench
