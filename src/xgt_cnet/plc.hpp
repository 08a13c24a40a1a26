// An emulated XGB PLC as XGT Cnet server.
#pragma once

#include <memory>

#include "src/plc/plc.hpp"
#include "src/plc/port_config.hpp"

namespace fieldproof::xgt_cnet {

/// Puts the server on a channel. Errors name the parameter that is out of its range.
Status add_server(plc::Plc& plc, unsigned channel, const plc::PortConfig& config);

/// A PLC in its power-on state with the server on channel 1. Errors name the model, or the
/// parameter.
Result<std::unique_ptr<plc::Plc>> make_plc(const plc::PortConfig& config);

}  // namespace fieldproof::xgt_cnet
