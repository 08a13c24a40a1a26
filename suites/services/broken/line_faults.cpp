// How a line is set (Cnet EN 4.3, 11.2; Cnet KO 4.3, 10.2): speed, format of a character, delay.
#include <nlohmann/json.hpp>

#include "harness/exchange/prepared_case.hpp"
#include "src/line/settings.hpp"
#include "suites/services/broken/faults.hpp"

namespace fieldproof::services_broken {

using line::LineSettings;
using nlohmann::json;

namespace {

LineSettings settings_of(const json& config, const char* key) {
  return *line::parse_line_settings(config.value(key, std::string("9600-8N1")));
}

/// Where the partner's line is another, that of the PLC takes something of it.
MakeBehaviour takes_from_partner(void (*take)(LineSettings& own, const LineSettings& partner)) {
  return [=] {
    return Behaviour{.set_up = [=](json& config) {
      if (!config.contains("bench_line")) return;
      LineSettings own = settings_of(config, "line");
      take(own, settings_of(config, "bench_line"));
      config["line"] = line::to_string(own);
    }};
  };
}

/// The line of the PLC is another than it was set to; that of its partner is the one set.
MakeBehaviour line_is(void (*change)(LineSettings& own)) {
  return [=] {
    return Behaviour{.set_up = [=](json& config) {
      LineSettings own = settings_of(config, "line");
      if (!config.contains("bench_line")) config["bench_line"] = line::to_string(own);
      change(own);
      config["line"] = line::to_string(own);
    }};
  };
}

MakeBehaviour delay(unsigned (*wrong)(unsigned right)) {
  return [=] {
    return Behaviour{.takes = [=](json& config) {
      if (!config.contains("delay_ms")) return;
      const int right = exchange::number_of(config, "delay_ms", 0);
      config["delay_ms"] = wrong(static_cast<unsigned>(right));
    }};
  };
}

Behaviour deaf_to_power() { return {.edge = {.deaf_to = "power_cycle"}}; }

}  // namespace

std::vector<Fault> line_faults() {
  return {
      {"speed_of_the_partner", "the speed is that of what comes, not the one that is set",
       takes_from_partner(
           [](LineSettings& own, const LineSettings& partner) { own.baud = partner.baud; }),
       "xgt_cnet/line/speed_differs/d9600_b19200", "where silence is due"},
      {"parity_of_the_partner", "the parity is that of what comes, not the one that is set",
       takes_from_partner(
           [](LineSettings& own, const LineSettings& partner) { own.parity = partner.parity; }),
       "xgt_cnet/line/parity_differs/d8e1_b8o1", "where silence is due"},
      {"format_of_the_partner", "data bits and parity are those of what comes",
       takes_from_partner([](LineSettings& own, const LineSettings& partner) {
         const int baud = own.baud;
         own = partner;
         own.baud = baud;
       }),
       "xgt_cnet/line/data_bits_differ/d8n1_b7n1", "where silence is due"},
      {"always_9600", "the speed is 9600 bit/s whatever is set",
       line_is([](LineSettings& own) { own.baud = 9600; }), "xgt_cnet/line/example_38400_8o1",
       "no answer within"},
      {"no_parity", "there is no parity whatever is set",
       line_is([](LineSettings& own) { own.parity = 'N'; }), "xgt_cnet/line/ko_example_115200_8o1",
       ""},
      {"always_8_bits", "there are 8 data bits whatever is set",
       line_is([](LineSettings& own) { own.data_bits = 8; }),
       "xgt_cnet/line/speed_and_format/s19200_7e1", ""},
      {"delay_not_kept", "the delay of RS-485 is not kept", delay([](unsigned) { return 0u; }),
       "xgt_cnet/line/delay/d1000", "bytes came"},
      {"delay_doubled", "the delay of RS-485 is twice as long",
       delay([](unsigned right) { return std::min(2 * right, 2550u); }),
       "xgt_cnet/line/delay/d1000", "late answer"},
      {"delay_halved", "the delay of RS-485 is half as long",
       delay([](unsigned right) { return right / 20 * 10; }), "modbus_rtu/timing/delay/d10",
       "bytes came"},
      {"power_changes_nothing", "requests, counters and calls outlive the power", deaf_to_power,
       "xgt_cnet/line/power_off_within_the_delay", ""},
  };
}

}  // namespace fieldproof::services_broken
