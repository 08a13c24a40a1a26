// The table of protocols: one line each.
#include <array>

#include "harness/protocol.hpp"
#include "suites/ls_bus/protocol.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/udata/protocol.hpp"
#include "suites/user_frames/protocol.hpp"
#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof {

std::span<const Protocol* const> protocols() {
  static const std::array table{&xgt_cnet::protocol(),    &modbus::rtu(),
                                &modbus::ascii(),         &ls_bus::protocol(),
                                &user_frames::protocol(), &udata::protocol()};
  return table;
}

}  // namespace fieldproof
