// The framings of Modbus: the two transmission modes of a serial line (Cnet EN and KO 9.2.1), and
// that of TCP (FEnet EN 5.3).
#pragma once

namespace fieldproof::modbus {

enum class ModbusMode { rtu, ascii, tcp };

}  // namespace fieldproof::modbus
