// The programs of real PLCs, as a profile declares them: which instruction stands behind which
// relay (`config.program`, and `program` of each of `config.stations`).
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "harness/protocol.hpp"

namespace fieldproof::xnet_suite {

class Ladder {
 public:
  /// Errors name the relay.
  static Result<Ladder> read(const nlohmann::json& config);

  /// What is set so that `action` of a case happens, "B:M100" where it is B's: the operands that
  /// stand in registers, then the relay, off and on. None: no instruction ("run"). Errors say what
  /// the program lacks.
  Result<std::vector<harness::Protocol::Setting>> set_off(std::string_view action) const;

 private:
  struct Rung {
    std::string of;                  // "", "B:"
    std::string relay, instruction;  // "M100", "REG_READ net 1 station D0 D0 count 10 to D10"
  };
  Status add(const nlohmann::json& program, const std::string& of);

  std::vector<Rung> rungs_;
};

}  // namespace fieldproof::xnet_suite
