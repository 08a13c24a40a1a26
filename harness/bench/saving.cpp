#include "harness/bench/saving.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace fieldproof::bench {

using exchange::PreparedCase;
using harness::Protocol;
using results::CaseResult;
using results::Verdict;

Duration patience_with(const Profile& profile) {
  return profile.response_max + exchange::number_of(profile.config, "delay_ms", 0) * 1ms;
}

Saving::Saving(endpoints::Endpoint& endpoint, const Protocol& protocol, const BenchOptions& options,
               const Eligibility& eligibility, Recovery& recovery)
    : endpoint_(endpoint),
      protocol_(protocol),
      options_(options),
      eligibility_(eligibility),
      recovery_(recovery),
      own_(endpoint, protocol, patience_with(options.profile), options.device, options.journal),
      over_aux_(options.aux.endpoint ? *options.aux.endpoint : endpoint,
                options.aux.protocol ? *options.aux.protocol : protocol,
                patience_with(options.profile), options.aux_device, options.journal) {}

/// What it sets in a partner of the device.
bool Saving::save_partner(const PreparedCase& prepared, CaseResult& result) {
  if (prepared.is_client() || !options_.aux) return true;
  const Status saved = over_aux_.save(*eligibility_.written_over_aux(prepared));
  if (saved) return true;
  result.verdict = over_aux_.port_failed() ? Verdict::error : Verdict::blocked;
  result.message = "--aux: " + saved.error().message;
  if (over_aux_.port_failed() || over_aux_.lost()) recovery_.stop(result.message, &saved.error());
  return false;
}

bool Saving::save(const PreparedCase& prepared, CaseResult& result) {
  answered_ = true;
  if (prepared.is_shut_out()) return true;  // what --control sets it puts back
  if (!save_partner(prepared, result)) return false;
  const std::vector<Protocol::Written> written = eligibility_.written_by(prepared);
  if (std::ranges::any_of(written, &Protocol::Written::unknown))
    result.notes.push_back(
        "not saved before: nobody can tell where a damaged write request would write");
  safety::SavedMemory& memory = memory_of(prepared);
  const Status saved = memory.save(written);
  answered_ = !memory.unserved();
  if (saved && memory.damaged() > 0 && !unchecked_writes(prepared).empty()) {
    result.verdict = Verdict::blocked;
    result.message = fmt::format(
        "the line has damaged {} answers to what the bench reads before it writes; this case "
        "writes by a request without a right check, which could write elsewhere when it is "
        "damaged, too. Mend the line (cable, termination, ground, speed)",
        memory.damaged());
    return false;
  }
  if (saved) return true;
  // A device that the bench starts itself forgets all with its process: there the case may name the
  // fault.
  if (endpoint_.capabilities().can_power_cycle && !memory.port_failed() && !prepared.is_client() &&
      options_.journal) {
    result.notes.push_back(saved.error().message);
    return !memory.lost() || recovery_.look_for_device(result, saved.error().message);
  }
  result.verdict = memory.port_failed() ? Verdict::error : Verdict::blocked;
  result.message = (prepared.is_client() ? "--aux: " : "") + saved.error().message;
  if (memory.port_failed())
    recovery_.stop("the port failed before " + result.id + ": " + result.message, &saved.error());
  else if (memory.lost())
    prepared.is_client() ? recovery_.stop(result.message)
                         : void(recovery_.look_for_device(result, saved.error().message));
  return false;
}

/// The requests of a case by which it writes without a check. A device that forgets all with its
/// process can lose nothing.
std::vector<Bytes> Saving::unchecked_writes(const PreparedCase& prepared) const {
  std::vector<Bytes> all;
  if (prepared.is_client() || endpoint_.capabilities().can_power_cycle) return all;
  for (const exchange::PreparedStep& step : prepared.steps)
    if (step.step->kind == vectors::Step::Kind::send)
      if (const Bytes& request = step.frames.front().frame.bytes;
          writes_without_check(request, protocol_))
        all.push_back(request);
  return all;
}

/// Memory that changes in a case without a request: the bench sets it, or does something to the
/// device after which anything may stand anywhere.
std::vector<Protocol::Written> Saving::changes(const PreparedCase& prepared) const {
  static const Protocol::Written anywhere{"?", 0, 0, ""};
  std::vector<Protocol::Written> all;
  for (const exchange::PreparedStep& step : prepared.steps) {
    if (step.step->kind == vectors::Step::Kind::act) all.push_back(anywhere);
    if (step.step->kind == vectors::Step::Kind::set)
      for (const auto& [address, digits] : step.step->memory)
        all.push_back(protocol_.named(address, digits.size()).value_or(anywhere));
  }
  return all;
}

bool Saving::put_back(CaseResult& result, bool stopped) {
  bool answered = true;
  for (safety::SavedMemory* memory : {&own_, &over_aux_}) {
    const std::string problem = memory->restore();
    if (problem.empty()) continue;
    const std::string note = "not put back what it wrote: " + problem;
    result.notes.push_back(note);
    if (memory != &own_ || stopped || memory->failure().interrupted) continue;
    answered = !memory->unserved();
    if (memory->port_failed())
      recovery_.stop(fmt::format("the port failed after {}: {}", result.id, problem),
                     &memory->failure());
    else if (memory->lost())
      recovery_.look_for_device(result, note);
  }
  return answered;
}

std::string Saving::restore() {
  std::string problems;
  for (safety::SavedMemory* memory : {&own_, &over_aux_})
    if (const std::string problem = memory->restore(); !problem.empty())
      problems += (problems.empty() ? "" : "; ") + problem;
  return problems;
}

std::string Saving::open_places() const {
  const std::string own = own_.open_places(), over_aux = over_aux_.open_places();
  return own + (own.empty() || over_aux.empty() ? "" : ", ") + over_aux;
}

}  // namespace fieldproof::bench
