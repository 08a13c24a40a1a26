// Token buses, motion buses and serial ports that do one thing wrong.
#include "suites/xnet/broken/rewrites.hpp"

namespace fieldproof::xnet_broken {

namespace {

/// Looked for in every run, not asked by any step.
Behaviour two_senders() {
  return {.trace = [](Trace& trace) {
    for (NetTrace& net : trace.nets)
      if (net.turns.size() > 1) net.turns[1].from -= 1ms;
  }};
}
Behaviour token_twice() {
  return {.trace = [](Trace& trace) {
    for (NetTrace& net : trace.nets)
      if (net.turns.size() > 2) net.turns[1].station = net.turns[0].station;
  }};
}
Behaviour sends_without_token() {
  return {.trace = [](Trace& trace) {
    for (NetTrace& net : trace.nets)
      for (TokenTurn& turn : net.turns)
        if (turn.busy > 0ns) turn.busy = turn.to - turn.from + 1ms;
  }};
}
Behaviour no_first_scan() {
  return {.config = [](json& config) {
    if (config.contains("program")) config["program"].erase("SM2");
  }};
}
Behaviour retries_are_10() {
  return {.config = [](json& config) {
    if (!config.contains("servos") || !config["servos"].is_array()) return;
    for (json& servo : config["servos"])
      if (servo.contains("P7-06")) servo["P7-06"] = 10;
  }};
}
/// Of a counter of the servo.
Make counter_shows(const std::string& counter, const std::string& other) {
  return [=] {
    return Behaviour{.look_name = [=](const std::string& text) {
      return text.starts_with("@" + counter) ? "@" + other + text.substr(counter.size() + 1) : text;
    }};
  };
}

}  // namespace

std::vector<Fault> bus_faults() {
  return {
      {"two_senders", "two stations have the token at one time", two_senders,
       "xnet/instruction_data/count_example", "have the token at one time"},
      {"token_twice", "a station has the token before its turn", token_twice,
       "xnet/timing_token/each_has_it", "has the token twice"},
      {"sends_without_token", "a station sends when its turn is over", sends_without_token,
       "xnet/timing_token/sends_in_its_turn", "sends longer than it has the token"},
      {"slow_station_unseen", "a slow station is as fast as any", ignores("slow"),
       "xnet/timing_token/slow_station/target", "SD161"},
      {"no_first_scan", "SM2 is never on", no_first_scan, "xnet/register_motion_flags/initial_on",
       "B:D10"},
      {"overtimes_not_counted", "U0-68 shows another counter", counter_shows("U0-68", "U0-67"),
       "xnet/timing_omms/overtime/ten", "U0-68"},
      {"sync_errors_among_data", "U0-62 counts data frames", counter_shows("U0-62", "U0-64"),
       "xnet/timing_omms/errors/sync", "U0-62"},
      {"retries_are_10", "P7-06 is not looked at", retries_are_10,
       "xnet/timing_omms/overtime/three_of_3", "U0-68"},
      {"modbus_results_of_port_0", "SD150 is that of port 0", moved("SD", 150, 150, -10),
       "xnet/register_results/modbus_ports/p1", "SD150"},
      {"address_error_is_400", "an address error has the code of a function code error",
       sees("SD", 140, 140, "0191", "0190"), "xnet/register_results/modbus/address_error", "SD140"},
      {"start_for_end_symbol", "no start symbol is told as no end symbol",
       sees("SD", 143, 143, "019F", "01A0"),
       "xnet/register_results/free_format_receive/no_start_symbol", "SD143"},
  };
}

}  // namespace fieldproof::xnet_broken
