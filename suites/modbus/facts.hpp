// What the `table` vectors of Modbus state, checked against the tables of the emulator and of this
// suite.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"

namespace fieldproof::modbus_suite {

/// `facts.table` names the table; the error says what it holds instead.
Status check_fact(const nlohmann::json& facts);

}  // namespace fieldproof::modbus_suite
