// The status by service (Cnet EN 11.1.4, Cnet KO 10.1.4): what is counted, and the last code.
#include <fmt/format.h>

#include "suites/services/broken/faults.hpp"

namespace fieldproof::services_broken {

namespace {

/// A counter is seen as `wrong` makes it of the right number.
MakeBehaviour counts(std::string_view counter, unsigned long (*wrong)(unsigned long right)) {
  return edge({.shows = [=](std::string_view address, std::string right) {
    if (address != counter) return right;
    return fmt::format("{:04X}", wrong(std::stoul(right, nullptr, 16)));
  }});
}

/// The first status that was no normal one stays.
Behaviour keeps_status() {
  return {.edge = {.shows = [first = std::string()](std::string_view address,
                                                    std::string right) mutable {
            if (address != "@status") return right;
            if (first.empty() && right != "00") first = right;
            return first.empty() ? right : first;
          }}};
}

}  // namespace

std::vector<Fault> counter_faults() {
  const auto never = [](unsigned long) { return 0ul; };
  const auto twice = [](unsigned long right) { return 2 * right; };
  const auto once = [](unsigned long right) { return std::min(right, 1ul); };
  return {
      {"services_not_counted", "a request that is answered is not counted",
       counts("@services", never), "xgt_cnet/status_by_service/counts_add_up", "@services"},
      {"services_counted_twice", "request and answer are counted each", counts("@services", twice),
       "modbus_ascii/status/quiet", "@services"},
      {"services_counted_once", "the count of services stays at 1", counts("@services", once),
       "xgt_cnet/status_by_service/each_service_counts", "@services"},
      {"errors_not_counted", "a frame that is no request is not counted", counts("@errors", never),
       "xgt_cnet/status_by_service/noise_before_request", "@errors"},
      {"errors_counted_once", "the count of errors stays at 1", counts("@errors", once),
       "xgt_cnet/status_by_service/noise_twice", "@errors"},
      {"status_never", "the status is always normal",
       shows("@status", {"01", "02", "03", "09", "0A", "0B", "0C", "0D"}, "00"),
       "xgt_cnet/status_by_service/no_bcc", "@status"},
      {"status_kept", "the first status that was not normal stays", keeps_status,
       "xgt_cnet/status_by_service/normal_again", "@status"},
      {"head_as_tail", "a frame without a head has the status of one without a tail",
       shows("@status", {"01"}, "02"), "xgt_cnet/status_by_service/no_head/lower", "@status"},
      {"tail_as_check", "a frame without a tail has the status of a wrong check",
       shows("@status", {"02"}, "03"), "xgt_cnet/status_by_service/no_tail/lower", "@status"},
      {"check_as_head", "a wrong check has the status of a frame without a head",
       shows("@status", {"03"}, "01"), "xgt_cnet/status_by_service/no_bcc", "@status"},
      {"too_long_as_check", "a frame that is too long has the status of a wrong check",
       shows("@status", {"0B"}, "03"), "modbus_rtu/status/too_long", "@status"},
      {"not_hex_as_check", "what is no hex digit has the status of a wrong check",
       shows("@status", {"0D"}, "03"), "modbus_ascii/status/not_hex", "@status"},
  };
}

}  // namespace fieldproof::services_broken
