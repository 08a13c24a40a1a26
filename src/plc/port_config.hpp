// Basic parameters that every protocol of a Cnet channel has (Cnet EN and KO 4.3.1), and their
// JSON.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/base/time.hpp"
#include "src/line/settings.hpp"
#include "src/plc/config_reader.hpp"
#include "src/plc/model.hpp"

namespace fieldproof::plc {

struct PortConfig {
  enum class Role { server, client };

  std::string model = "xbc-h";
  unsigned station = 0;  // 0-255 (table 4.3.1; the 0-31 of 9.3 is what one line carries)
  Role role = Role::server;
  bool run = true;  // STOP: servers keep answering, the client is silent
  line::LineSettings line{};
  Duration inter_character{};        // 0: 3.5 characters of 11 bits
  Duration inter_character_floor{};  // 20 ms behind a pty or socket
  Duration delay{};                  // of a reply, 0-2550 ms in steps of 10 ms; only with rs485
  bool rs485 = false;

  /// The inter-character time that holds (effective_gap).
  Duration gap() const;
  /// The delay that holds.
  Duration reply_delay() const { return rs485 ? delay : Duration::zero(); }

  bool operator==(const PortConfig&) const = default;
};

/// The inter-character time: `parameter`, or 3.5 characters of 11 bits where it is zero, but at
/// least `floor` (a pty or socket has no wire time).
Duration effective_gap(Duration parameter, Duration floor, const line::LineSettings& line);

/// The keys of `read_port_config`, those for others (bench_line, model, neighbours, protocol),
/// which are passed over, and `more`: for `known_keys`.
std::vector<std::string_view> port_keys(std::initializer_list<std::string_view> more = {});

/// The keys that a service of the Ethernet module passes over or reads itself (mode, role, station,
/// and the others of `port_keys` that are no affair of a line), and `more`.
std::vector<std::string_view> network_keys(std::initializer_list<std::string_view> more = {});

/// station, role, mode, line, inter_character_ms, inter_character_floor_ms, delay_ms, rs485.
void read_port_config(ConfigReader& reader, PortConfig& to);

/// The error names it, and those there are.
Result<const PlcModel*> known_plc_model(std::string_view name);

/// The model. Errors name it, or the parameter that is out of its range.
Result<const PlcModel*> check_port_config(const PortConfig& config);

}  // namespace fieldproof::plc
