// The checks that frames of these protocols end with, as the notation computes them.
#pragma once

#include "harness/notation/check.hpp"

namespace fieldproof::checks {

/// "BCC", XGT (Cnet EN 7.1.5): low byte of the sum from header to tail, two hex digits. Frames
/// whose main command is in upper case have none (Cnet EN 7.1.2 Note 5).
extern const notation::Check bcc;
/// "SUM", LS Bus (Cnet EN 8): low byte of the sum between header and sum, two hex digits.
extern const notation::Check sum;
/// "CRC", Modbus RTU (Cnet EN 9.3): CRC-16, polynomial A001, start FFFF, low byte first.
extern const notation::Check crc;
/// "LRC", Modbus ASCII (Cnet EN 9.3): two's complement of the sum of the bytes that the hex pairs
/// behind ':' stand for, two hex digits.
extern const notation::Check lrc;
/// "LEN", Modbus TCP (FEnet EN 5.3): how many bytes follow in the frame, two bytes, high first.
extern const notation::Check length;
/// "LEN" and "SUM" of the XGT FEnet header (FEnet EN 5.2.3, table 5-3): the bytes of the body, two
/// bytes, low first, that is all but position and check of what follows in the frame; and the low
/// byte of the sum of the header's bytes before it.
extern const notation::Check fenet_length, fenet_sum;

}  // namespace fieldproof::checks
