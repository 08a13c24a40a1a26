// The P2P drivers 'Modbus RTU client' and 'Modbus ASCII client' (Cnet EN tables 6.2.1
// to 6.2.4, 10.3; Cnet KO 6.4.2), and 'Modbus TCP client' (FEnet EN 7.2, 7.3.2, table 7-4, 7.6).
//
// A block has one variable, of type bit or word, and sends one request: p2p_address.hpp says with
// which function code. Most elements of a continuous block, so that no ASCII frame has more than
// 255 characters:
//
//          read bits   read words   write bits   write words
//   RTU    2000        120          1968         120
//   ASCII  976         61           944          59 (Cnet KO prints 120, which is 499 characters:
//                                                DECISIONS.md modbus/ascii-length)
//   TCP    2000        125          1968         123 (decision: what the protocol carries)
//
// By TCP, transactions are numbered from 1; a frame of another transaction, or of another protocol,
// is no reply to the one under way, which goes on waiting.
//
// Where a parameter is what 11.1.4 calls 'Modbus address error' or 'commands except Read/Write'
// (status FFFE), `check` refuses it: XG5000 takes the address apart when it is entered. So no block
// that runs can end with FFFE.
//
// What a reply that is not the one asked for gives (Appendix 3.3; where several codes would
// fit: DECISIONS.md p2p/wrong-driver, p2p/check-first, p2p/reply-length):
//   01  ASCII: characters, but no ':'       02  ASCII: no CR LF within a second
//   03  CRC or LRC                          04  another station
//   05  another function code, or the       0B  byte count, or length of the frame
//       echo of another write
//   0D  ASCII: no pairs of hex digits       0F  exception, whatever its code
#pragma once

#include <memory>

#include "src/modbus/modbus_mode.hpp"
#include "src/p2p/driver.hpp"

namespace fieldproof::modbus {

/// `gap`: the inter-character time, by which RTU frames end (rtu_receiver.hpp).
std::unique_ptr<p2p::P2pDriver> make_modbus_p2p_driver(ModbusMode mode, Duration gap = {});

}  // namespace fieldproof::modbus
