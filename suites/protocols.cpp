#include "suites/protocols.hpp"

#include <array>

#include "suites/email/protocol.hpp"
#include "suites/hs_link/protocol.hpp"
#include "suites/ls_bus/protocol.hpp"
#include "suites/modbus/protocol.hpp"
#include "suites/udata/protocol.hpp"
#include "suites/user_frames/protocol.hpp"
#include "suites/xgt_cnet/protocol.hpp"
#include "suites/xgt_fenet/protocol.hpp"
#include "suites/xnet/protocol.hpp"

namespace fieldproof::suites {

harness::Protocols protocols() {
  // One line each; the first is the default.
  static const std::array table{&xgt_cnet_suite::protocol(),
                                &modbus_suite::rtu(),
                                &modbus_suite::ascii(),
                                &modbus_suite::tcp(),
                                &ls_bus_suite::protocol(),
                                &user_frames_suite::protocol(),
                                &udata_suite::protocol(),
                                &xgt_fenet_suite::protocol(),
                                &hs_link_suite::protocol(),
                                &xnet_suite::protocol(),
                                &user_frames_suite::protocol(user_frames_suite::Way::network),
                                &email_suite::protocol()};
  return std::span<const harness::Protocol* const>(table);
}

}  // namespace fieldproof::suites
