#include "reports/text/run_text.hpp"

#include <fmt/format.h>

#include "reports/text/xml_text.hpp"

namespace fieldproof::text {

using results::Verdict;

std::string verdict_meaning(Verdict verdict) {
  switch (verdict) {
    case Verdict::pass: return "as the manual says";
    case Verdict::marginal: return "within limits, inside the guard band";
    case Verdict::non_strict: return "an allowed alternative, or a SHOULD missed";
    case Verdict::info: return "measured, the manual gives no limit";
    case Verdict::fail: return "violates a MUST";
    case Verdict::xfail: return "waived failure";
    case Verdict::xpass: return "a waiver that no longer holds";
    case Verdict::skip: return "outside the profile of the device";
    case Verdict::blocked: return "needs a permission, fixture or mode not given";
    case Verdict::inconclusive: return "the bench cannot judge (not read, noise, timing floor)";
    case Verdict::error: return "port, emulator, vector or harness trouble";
  }
  return "";
}

std::string gate_hint(Verdict verdict, const results::Gate& gate) {
  if (results::gates(verdict, gate)) return "";
  switch (verdict) {
    case Verdict::marginal: return "; red with --fail-on marginal";
    case Verdict::non_strict: return "; red with --strict";
    case Verdict::blocked:
    case Verdict::inconclusive: return "; red with --qualify";
    default: return "";
  }
}

std::string headline(const results::RunEnd& end, const Tally& tally) {
  std::string text = xml_line(results::to_string(end.reasons));
  if (text.empty()) {
    text = exit_meaning(end.exit_code);
    if (end.exit_code == 0 && is_less_than_half(tally))
      text += fmt::format(" by less than half: {} ({:.1f}%); --min-judged says how much is enough",
                          judged_text(tally), share_judged(tally));
    else if (tally.applicable() > 0)
      text += ": " + judged_text(tally);
  }
  if (!end.hint.empty()) text += "; " + xml_line(end.hint);
  return text;
}

std::string device_text(const results::DutInfo& dut) {
  const results::Identity& device = dut.identity;
  std::string text = device.maker;
  const auto add = [&](const std::string& separator, const std::string& value) {
    if (!value.empty()) text += (text.empty() ? "" : separator) + value;
  };
  add(" ", device.model);
  if (!device.serial.empty()) add(", ", "serial number " + device.serial);
  if (!device.firmware.empty()) add(", ", "firmware " + device.firmware);
  add(", ", "at " + dut.endpoint);
  for (const auto& [name, value] : dut.properties) add(", ", name + ' ' + value);
  return text;
}

std::string early_end(const results::RunLog& log) {
  if (!log.end) {
    const char* incomplete = log.truncated ? ", and one incomplete" : "";
    const std::string soak = results::killed_soak_text(log.samples);
    return fmt::format("the run was killed: {} results were written before{}{}{}", log.results,
                       incomplete, soak.empty() ? "" : "; ", soak);
  }
  if (log.end->interrupted)
    return "the run was interrupted" + (log.end->trouble.empty() ? "" : ": " + log.end->trouble);
  return log.end->trouble;
}

}  // namespace fieldproof::text
