// One UDATA instruction out of its JSON: the operands of Cnet KO 6.6, by the names that the manual
// gives their meaning.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "src/base/result.hpp"
#include "src/udata/instruction.hpp"

namespace fieldproof::udata {

/// `number`: the position in the list, from 0, for messages. An operand must lie in an area that
/// the operand tables of 6.6.5 to 6.6.8 allow (P M K L U D R of XBC), and what is written in a
/// writable one.
Result<UdataInstruction> read_udata_instruction(const nlohmann::json& object, std::size_t number,
                                                const plc::PlcModel& model);

}  // namespace fieldproof::udata
