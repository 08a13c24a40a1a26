#include "src/udata/instruction.hpp"

namespace fieldproof::udata {

using plc::PlcMemory;

using Operation = UdataInstruction::Operation;

bool misses_module(const UdataInstruction& instruction, const UdataModule& module) {
  return instruction.base != 0 || instruction.slot != module.slot || !module.cnet;
}

namespace {

bool right_value(const UdataInstruction& instruction, const PlcMemory& memory) {
  const unsigned value = instruction.value.read(memory);
  switch (instruction.operation) {
    case Operation::receive: return true;
    case Operation::send:
      return value >= 1 && value <= udata_max && plc::fits(memory.model(), instruction.data, value);
    default: return value <= 1;
  }
}

}  // namespace

std::uint16_t check_udata(const UdataInstruction& instruction, const UdataModule& module,
                          const PlcMemory& memory) {
  if (misses_module(instruction, module)) return udata_status::module;
  const unsigned channel = instruction.channel.read(memory);
  if (channel < 1 || channel > 2) return udata_status::channel;
  if (!right_value(instruction, memory)) return udata_status::value;
  // The module's other channel is on no line here, and not set up.
  if (channel != module.channel || !module.user_frames || !module.link)
    return udata_status::parameters;
  return module.new_enough ? udata_status::done : udata_status::version;
}

void put_status(const UdataInstruction& instruction, std::uint16_t status, PlcMemory& memory) {
  if (instruction.status) memory.write(*instruction.status, status);
  if (instruction.done) memory.write(*instruction.done, status == udata_status::done ? 1 : 0);
}

Bytes read_data(const UdataInstruction& instruction, const PlcMemory& memory) {
  Bytes data(instruction.value.read(memory));
  for (std::uint32_t i = 0; i < data.size(); ++i)
    data[i] = static_cast<Byte>(memory.read(instruction.data + i));
  return data;
}

void put_data(const UdataInstruction& instruction, ByteView data, PlcMemory& memory) {
  for (std::uint32_t i = 0; i < data.size(); ++i) memory.write(instruction.data + i, data[i]);
  if (instruction.size) memory.write(*instruction.size, data.size());
}

}  // namespace fieldproof::udata
