// Faults of what XG5000 shows of the module (FEnet EN tables 2-8, 2-9; DECISIONS.md
// fenet/diagnosis).
#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

std::vector<Fault> counter_faults() {
  return {
      {"errors_not_received", "a packet that draws no answer is not counted as received",
       shows("@received", "@services"), "xgt_fenet/status/packets", ""},
      {"errors_sent", "a packet that draws no answer is counted as sent",
       shows("@sent", "@received"), "xgt_fenet/status/packets", ""},
      {"state_of_requests", "the state counts requests, not connections",
       shows("@state", "@services"), "xgt_fenet/status/state", ""},
      {"no_driver", "no driver is shown", shows("@driver", "@errors"), "xgt_fenet/status/driver",
       ""},
      {"total_of_the_service", "the medium counts what reaches the server alone",
       shows("@total_received", "@received"), "xgt_fenet/status/medium_host_table", ""},
      {"all_is_udp", "what comes over connections is counted as UDP",
       shows("@udp_received", "@total_received"), "xgt_fenet/status/medium", ""},
      {"echo_of_the_medium", "what is received is counted as sent",
       shows("@total_sent", "@total_received"), "xgt_fenet/status/medium_host_table", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
