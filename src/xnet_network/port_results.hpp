// What a serial port of a PLC shows of Modbus instructions and free format communication, beside
// X-NET (1-5-1). The manual prints neither those instructions nor their frames: what became of one
// is told, in the words of the table.
#pragma once

#include <string_view>

#include "src/base/result.hpp"
#include "src/xnet/memory.hpp"
#include "src/xnet_network/configuration.hpp"

namespace fieldproof::xnet {

/// Does it begin as one of what tell_port_result() takes?
bool is_port_result(std::string_view action);

/// "modbus port 2 address error", "free format port 2 send correct", "free format port 2 receive
/// no start symbol", "free format port 2 received 12 bytes". Errors name the word.
Status check_port_result(std::string_view action, const Model& model);
/// The same, and memory shows it.
Status tell_port_result(std::string_view action, const Model& model, Memory& memory);

}  // namespace fieldproof::xnet
