// The UDATA instructions of Cnet KO 6.6: what one is given, and the status that it ends with. MK
// (XBC): SNDUDATA, RCVUDATA, SENDDTR, SENDRTS; IEC (XEC): SEND_UDATA, RCV_UDATA, SEND_DTR,
// SEND_RTS.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "src/base/bytes.hpp"
#include "src/plc/address.hpp"
#include "src/plc/memory.hpp"

namespace fieldproof::udata {

constexpr unsigned udata_max = 1024;  // bytes that one instruction sends, or receives

/// The status codes that 6.6.1 to 6.6.8 print.
namespace udata_status {
constexpr std::uint16_t before = 0, done = 1, module = 2, channel = 3, value = 4, parameters = 5,
                        time_out = 6, version = 7;
}

/// The module whose channel is on this line, and how that channel is set up.
struct UdataModule {
  unsigned slot = 1;  // 0: the built-in channels (Cnet KO 10.1.2)
  bool cnet = true;
  bool new_enough = true;  // an external module: V1.4 or above
  unsigned channel = 2;
  bool user_frames = true;  // the P2P driver of the channel
  bool link = true;         // link enable
  bool hangs = false;       // does not answer the CPU
};

/// A constant, or a word of memory that is read at the rising edge.
struct UdataOperand {
  std::uint16_t constant = 0;
  std::optional<plc::DeviceAddress> word{};

  unsigned read(const plc::PlcMemory& memory) const {
    return word ? static_cast<unsigned>(memory.read(*word)) : constant;
  }
};

struct UdataInstruction {
  enum class Operation { send, receive, dtr, rts };

  std::string name;  // "SNDUDATA"
  Operation operation = Operation::send;
  bool iec = false;
  plc::DeviceAddress request{};  // a bit
  unsigned base = 0, slot = 0;   // MK: sl; an XGB has base 0 alone
  UdataOperand channel{};
  UdataOperand value{};                        // send: bytes; DTR and RTS: the level
  plc::DeviceAddress data{};                   // send and receive: a byte
  std::optional<plc::DeviceAddress> status{};  // MK: D, three reserved words follow; IEC: STAT
  std::optional<plc::DeviceAddress> done{};    // IEC: a bit
  std::optional<plc::DeviceAddress> size{};    // receive: where the size goes
};

/// What the instruction meets, in the order of the codes: `done` when nothing stands in its way
/// (DECISIONS.md udata/order-of-codes). Whether there is data, and whether the module answers,
/// shows later.
std::uint16_t check_udata(const UdataInstruction& instruction, const UdataModule& module,
                          const plc::PlcMemory& memory);

/// Does it name a base and slot where no Cnet module is? MK sets F110 for it.
bool misses_module(const UdataInstruction& instruction, const UdataModule& module);

/// The outputs: status, and DONE of IEC.
void put_status(const UdataInstruction& instruction, std::uint16_t status, plc::PlcMemory& memory);

/// The bytes to send: of a word, the low one first.
Bytes read_data(const UdataInstruction& instruction, const plc::PlcMemory& memory);
/// Stores what was received, and its size.
void put_data(const UdataInstruction& instruction, ByteView data, plc::PlcMemory& memory);

}  // namespace fieldproof::udata
