#include "src/modbus/receiver.hpp"

#include "src/modbus/ascii_receiver.hpp"
#include "src/modbus/rtu_receiver.hpp"

namespace fieldproof::modbus {

std::unique_ptr<ModbusReceiver> make_modbus_receiver(ModbusMode mode, Duration gap) {
  if (mode == ModbusMode::rtu) return std::make_unique<RtuReceiver>(gap);
  return std::make_unique<AsciiReceiver>();
}

}  // namespace fieldproof::modbus
