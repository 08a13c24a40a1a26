// The JSON of a UDATA port (vectors/README.md, `given.config`): its module, and the instructions of
// its program.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>
#include <vector>

#include "src/base/result.hpp"
#include "src/plc/port_config.hpp"
#include "src/udata/instruction.hpp"

namespace fieldproof::udata {

struct UdataConfig {
  plc::PortConfig port;
  const plc::PlcModel* plc = nullptr;
  UdataModule module;
  std::vector<UdataInstruction> instructions;
};

/// Errors name the instruction and the key. XBC has the MK instructions, XEC those of IEC, XBM none
/// (Cnet KO 2.2).
Result<UdataConfig> parse_udata_config(std::string_view model, const nlohmann::json& config);

}  // namespace fieldproof::udata
