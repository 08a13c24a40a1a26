// The programs of real PLCs, as a profile declares them: which instruction stands behind which
// relay (`config.program`, and `program` of each of `config.stations`).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"
#include "src/xnet/areas.hpp"

namespace fieldproof::xnet_suite {

class Ladder {
 public:
  /// Errors name the relay.
  static Result<Ladder> read(const nlohmann::json& config);

  /// What is set so that `action` of a case happens, "B:M100" where it is B's: the operands that
  /// stand in registers, then the relay, off and on. None: no instruction ("run"). Errors say what
  /// the program lacks.
  Result<std::vector<harness::Protocol::Setting>> set_off(std::string_view action) const;
  /// Where the data instruction `action` writes, as far as that lies in a PLC of `series`: in the
  /// one that executes it, or in the station that it names. Values are zeros.
  std::vector<harness::Protocol::Setting> written_by(std::string_view action,
                                                     xnet::Series series) const;
  /// The axis that the instruction behind a relay of the PLC itself moves, or empty.
  std::string axis_behind(std::string_view relay) const;

 private:
  struct Rung {
    std::string of;                  // "", "B:"
    std::string relay, instruction;  // "M100", "REG_READ net 1 station D0 D0 count 10 to D10"
  };
  struct Station {
    std::string of;
    std::uint32_t net = 0, station = 0;
  };
  Status add(const nlohmann::json& plc, const std::string& of);
  const Station* station(std::uint32_t net, std::uint32_t number) const;
  Status names_target(std::string_view instruction) const;

  std::vector<Rung> rungs_;
  std::vector<Station> stations_;
};

}  // namespace fieldproof::xnet_suite
