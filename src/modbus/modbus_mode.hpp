// The two transmission modes of Modbus (000 and 003 9.2.1).
#pragma once

namespace fieldproof::modbus {

enum class ModbusMode { rtu, ascii };

}  // namespace fieldproof::modbus
