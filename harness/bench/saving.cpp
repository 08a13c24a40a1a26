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
  if (over_aux_.port_failed() || over_aux_.silent()) recovery_.stop(result.message, &saved.error());
  return false;
}

bool Saving::save(const PreparedCase& prepared, CaseResult& result) {
  answered_ = true;
  if (!save_partner(prepared, result)) return false;
  const std::vector<Protocol::Written> written = eligibility_.written_by(prepared);
  if (std::ranges::any_of(written, &Protocol::Written::unknown))
    result.notes.push_back(
        "not saved before: nobody can tell where a damaged write request would write");
  safety::SavedMemory& memory = memory_of(prepared);
  const Status saved = memory.save(written);
  answered_ = !memory.unserved();
  if (saved && memory.damaged() > 0 && writes_without_check(prepared)) {
    result.verdict = Verdict::blocked;
    result.message = fmt::format(
        "the line has damaged {} answers to what the bench reads before it writes; this case "
        "writes by a request without a check, which could write elsewhere when it is damaged, too. "
        "Mend the line (cable, termination, ground, speed)",
        memory.damaged());
    return false;
  }
  if (saved) return true;
  // A device that the bench starts itself forgets all with its process: there the case may name the
  // fault.
  if (endpoint_.capabilities().can_power_cycle && !memory.port_failed() && !prepared.is_client() &&
      options_.journal) {
    result.notes.push_back(saved.error().message);
    return !memory.silent() || recovery_.look_for_device(result, saved.error().message);
  }
  result.verdict = memory.port_failed() ? Verdict::error : Verdict::blocked;
  result.message = (prepared.is_client() ? "--aux: " : "") + saved.error().message;
  if (memory.port_failed())
    recovery_.stop("the port failed before " + result.id + ": " + result.message, &saved.error());
  else if (memory.silent())
    prepared.is_client() ? recovery_.stop(result.message)
                         : void(recovery_.look_for_device(result, saved.error().message));
  return false;
}

/// On a line; a network has its own checks.
bool Saving::writes_without_check(const PreparedCase& prepared) const {
  if (protocol_.default_port() != 0 || !protocol_.memory() || prepared.is_client()) return false;
  return std::ranges::any_of(prepared.steps, [&](const exchange::PreparedStep& step) {
    if (step.step->kind != vectors::Step::Kind::send) return false;
    const Bytes& request = step.frames.front().frame.bytes;
    return !protocol_.written_by(request).empty() && !protocol_.memory()->is_checked(request);
  });
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
