#include "src/modbus/data_space.hpp"

namespace fieldproof::modbus {

bool PlcDataSpace::covers(ModbusBase table, std::uint32_t address, std::uint32_t count,
                          bool to_write) const {
  const ModbusTable& placed = tables_[table];
  const bool writable = memory_.model().areas[placed.first.area].write;
  return address + count <= placed.size && (writable || !to_write);
}

}  // namespace fieldproof::modbus
