// What lies behind the data addresses of a Modbus server: four tables of bits or words. Which
// memory they show is the affair of the device (bases.hpp for an XGB PLC).
#pragma once

#include <cstdint>

#include "src/modbus/bases.hpp"
#include "src/plc/memory.hpp"

namespace fieldproof::modbus {

class DataSpace {
 public:
  virtual ~DataSpace() = default;

  /// Are `count` elements from data address `address` on there, and, for a write, writable?
  virtual bool covers(ModbusBase table, std::uint32_t address, std::uint32_t count,
                      bool to_write) const = 0;
  /// One element that is covered: a bit is 0 or 1.
  virtual unsigned read(ModbusBase table, std::uint32_t address) const = 0;
  virtual void write(ModbusBase table, std::uint32_t address, unsigned value) = 0;
  /// All that a request writes is written.
  virtual void written() {}
};

/// The tables of an XGB PLC, in its memory. What it writes, P2P may fire by.
class PlcDataSpace : public DataSpace {
 public:
  /// `memory` outlives it.
  PlcDataSpace(const ModbusTables& tables, plc::PlcMemory& memory)
      : tables_(tables), memory_(memory) {}

  bool covers(ModbusBase table, std::uint32_t address, std::uint32_t count,
              bool to_write) const override;
  unsigned read(ModbusBase table, std::uint32_t address) const override {
    return static_cast<unsigned>(memory_.read(tables_[table].first + address));
  }
  void write(ModbusBase table, std::uint32_t address, unsigned value) override {
    memory_.write(tables_[table].first + address, value);
  }
  void written() override { memory_.written(); }

 private:
  ModbusTables tables_;
  plc::PlcMemory& memory_;
};

}  // namespace fieldproof::modbus
