// Where a PLC shows its P2P service: results in L (Cnet EN and KO Appendix 2.1 (3)), parameters in
// N (Appendix 2.2).
//
//   L word 512 + 192 (p - 1) + 6 b   bit 0 NDR, bit 1 ERR; + 1 STATUS; + 2 service count, + 4
//                                    error count (dwords)
//   N word 1312 (p - 1) + 41 b       station of the partner; four times name (4 words) and size of
//                                    the read areas; the same of the save areas
//   on XEC 1568 (p - 1) + 49 b       the same, with names of 5 words
//
// What the words of a name hold is printed nowhere (DECISIONS.md p2p/names-in-n): the name as it
// goes out ("%MW100"), in ASCII, the first character in the low byte, NUL behind it: the longest
// unpadded names ("%DB20479", "%IW15.15.3") have just 8 and 10 characters. A longer one is cut. The
// size is in bytes, the unit of 'Data size' (Cnet EN table 6.2.3); a bit has 1.
#pragma once

#include <array>
#include <string>

#include "src/p2p/parameters.hpp"
#include "src/plc/memory.hpp"

namespace fieldproof::p2p {

// A channel of an Ethernet module has no station; its number stands there (decision).

struct P2pResultFlags {
  plc::DeviceAddress ndr, err;          // bits: the last service ended normally, or not
  plc::DeviceAddress status;            // word: p2p_error
  plc::DeviceAddress services, errors;  // dwords: counts
};

/// `parameter` 1-3, `block` 0-31.
P2pResultFlags p2p_result_flags(const plc::PlcModel& model, unsigned parameter, unsigned block);

struct P2pRegisters {
  struct Area {
    plc::DeviceAddress name;  // the first of its words
    plc::DeviceAddress size;
  };
  plc::DeviceAddress station;
  std::array<Area, p2p_max_variables> read, save;
  unsigned name_words = 0;
};

P2pRegisters p2p_registers(const plc::PlcModel& model, unsigned parameter, unsigned block);

/// Writes the parameters where the PLC shows them; those of other blocks are left alone.
void write_p2p_registers(plc::PlcMemory& memory, const P2pParameters& parameters);

/// "%MW100": as it goes out, without leading zeros.
std::string device_name(const plc::PlcModel& model, const plc::DeviceAddress& address);

}  // namespace fieldproof::p2p
