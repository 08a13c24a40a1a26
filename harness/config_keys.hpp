// The keys of a configuration: `given.config` of a vector, `config` of a profile, the marks of a
// command that is started for a case. vectors/README.md tells what each means.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace fieldproof::harness {

// clang-format off
inline constexpr auto config_keys = std::to_array<std::string_view>({
    "station", "role", "mode", "line", "rs485", "neighbours", "delay_ms", "inter_character_ms",
    "time_out", "p2p", "bit_read_base", "bit_write_base", "tables", "word_read_base",
    "word_write_base", "write_order", "definition", "connections", "waiting_time", "header_check",
    "base", "slot", "error", "host_table", "services", "monitor", "instructions", "module",
    "driver", "version", "bench_line", "stations", "servos", "ports", "routes", "ip", "port",
    "channel", "modem", "sms", "network", "network_ms", "dtr", "rts", "link", "reply_end",
    "module_hangs", "hs_link", "program", "as_shipped"});
// clang-format on

inline bool is_config_key(std::string_view word) {
  return std::ranges::find(config_keys, word) != config_keys.end();
}

}  // namespace fieldproof::harness
