// The two transmission modes of Modbus (Cnet EN and KO 9.2.1).
#pragma once

namespace fieldproof::modbus {

enum class ModbusMode { rtu, ascii };

}  // namespace fieldproof::modbus
