#include "src/modbus/receiver.hpp"

#include "src/modbus/ascii_receiver.hpp"
#include "src/modbus/mbap_receiver.hpp"
#include "src/modbus/rtu_receiver.hpp"

namespace fieldproof::modbus {

std::unique_ptr<ModbusReceiver> make_modbus_receiver(ModbusMode mode, Duration gap) {
  switch (mode) {
    case ModbusMode::rtu: return std::make_unique<RtuReceiver>(gap);
    case ModbusMode::ascii: return std::make_unique<AsciiReceiver>();
    case ModbusMode::tcp: break;
  }
  return std::make_unique<MbapReceiver>();
}

}  // namespace fieldproof::modbus
