#include "suites/protocols.hpp"

#include <array>

#include "suites/ls_bus/protocol.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/udata/protocol.hpp"
#include "suites/user_frames/protocol.hpp"
#include "suites/xgt_cnet/protocol.hpp"

namespace fieldproof {

Protocols protocols() {
  // One line each; the first is the default.
  static const std::array table{&xgt_cnet::protocol(),    &modbus::rtu(),
                                &modbus::ascii(),         &ls_bus::protocol(),
                                &user_frames::protocol(), &udata::protocol()};
  return std::span<const Protocol* const>(table);
}

}  // namespace fieldproof
