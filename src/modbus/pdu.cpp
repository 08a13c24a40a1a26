#include "src/modbus/pdu.hpp"

#include <algorithm>
#include <array>

namespace fieldproof::modbus {

namespace {
constexpr Byte read_coils = 0x01, read_inputs = 0x02, write_coil = 0x05, write_register = 0x06,
               write_coils = 0x0F, write_registers = 0x10;

constexpr std::array functions{
    ModbusFunction{0x01, "Read Coil Status", ModbusBase::bit_write, 2000},
    ModbusFunction{0x02, "Read Input Status", ModbusBase::bit_read, 2000},
    ModbusFunction{0x03, "Read Holding Registers", ModbusBase::word_write, 125},
    ModbusFunction{0x04, "Read Input Registers", ModbusBase::word_read, 125},
    ModbusFunction{0x05, "Force Single Coil", ModbusBase::bit_write, 1},
    ModbusFunction{0x06, "Preset Single Register", ModbusBase::word_write, 1},
    ModbusFunction{0x0F, "Force Multiple Coils", ModbusBase::bit_write, 1968},
    ModbusFunction{0x10, "Preset Multiple Registers", ModbusBase::word_write, line_write_limit},
};

bool writes(Byte code) {
  return code == write_coil || code == write_register || code == write_coils ||
         code == write_registers;
}
bool writes_one(Byte code) { return code == write_coil || code == write_register; }
bool handles_bits(Byte code) {
  return code == read_coils || code == read_inputs || code == write_coil || code == write_coils;
}

std::size_t data_bytes(Byte code, std::uint32_t count) {
  return handles_bits(code) ? (count + 7) / 8 : std::size_t{2} * count;
}

/// Everything that only the request itself can break: its length, count, byte count and the value
/// of a coil.
Byte check_form(ModbusRequest& request, ByteView pdu, unsigned write_limit) {
  constexpr std::size_t head = 5;  // function, address, count or value
  constexpr Byte wrong = modbus_exception::value;
  if (pdu.size() < head) return wrong;
  request.address = word_at(pdu, 1);
  const unsigned second = word_at(pdu, 3);
  if (writes_one(request.code)) {
    request.count = 1;
    request.data = pdu.subspan(3);
    const bool coil_value = second == coil_on || second == coil_off;
    return pdu.size() != head || (request.code == write_coil && !coil_value)
               ? wrong
               : modbus_exception::none;
  }
  request.count = second;
  const unsigned most = request.code == write_registers ? write_limit : request.function->limit;
  if (request.count == 0 || request.count > most) return wrong;
  if (!writes(request.code)) return pdu.size() != head ? wrong : modbus_exception::none;
  if (pdu.size() == head) return wrong;
  request.data = pdu.subspan(head + 1);
  const std::size_t expected = data_bytes(request.code, request.count);
  return pdu[head] != expected || request.data.size() != expected ? wrong : modbus_exception::none;
}

Bytes read(const ModbusRequest& request, const DataSpace& data) {
  const ModbusBase table = request.function->base;
  const std::size_t size = data_bytes(request.code, request.count);
  Bytes reply{request.code, static_cast<Byte>(size)};
  if (handles_bits(request.code)) {
    reply.resize(reply.size() + size);
    for (std::uint32_t i = 0; i < request.count; ++i) {
      const unsigned bit = data.read(table, request.address + i);
      reply[2 + i / 8] = static_cast<Byte>(reply[2 + i / 8] | bit << i % 8);
    }
  } else {
    for (std::uint32_t i = 0; i < request.count; ++i)
      put_word(reply, data.read(table, request.address + i));
  }
  return reply;
}

Bytes write(const ModbusRequest& request, DataSpace& data) {
  for (std::uint32_t i = 0; i < request.count; ++i) {
    unsigned value = 0;
    if (request.code == write_coil)
      value = word_at(request.data, 0) == coil_on;
    else if (request.code == write_coils)
      value = request.data[i / 8] >> i % 8 & 1;
    else
      value = word_at(request.data, std::size_t{2} * i);
    data.write(request.function->base, request.address + i, value);
  }
  data.written();
  Bytes reply{request.code};
  put_word(reply, request.address);
  put_word(reply, writes_one(request.code) ? word_at(request.data, 0) : request.count);
  return reply;
}
}  // namespace

std::uint16_t word_at(ByteView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

void put_word(Bytes& to, std::uint64_t value) {
  to.push_back(static_cast<Byte>(value >> 8));
  to.push_back(static_cast<Byte>(value));
}

std::span<const ModbusFunction> modbus_functions() { return functions; }

const ModbusFunction* find_modbus_function(Byte code) {
  const auto found = std::ranges::find(functions, code, &ModbusFunction::code);
  return found == functions.end() ? nullptr : &*found;
}

ModbusRequest parse_modbus_request(ByteView pdu, unsigned write_limit) {
  ModbusRequest request{.code = pdu.front(), .function = find_modbus_function(pdu.front())};
  request.exception =
      request.function ? check_form(request, pdu, write_limit) : modbus_exception::function;
  return request;
}

Bytes execute_modbus_request(const ModbusRequest& request, DataSpace& data) {
  if (request.exception != modbus_exception::none)
    return modbus_exception_reply(request.code, request.exception);
  const bool to_write = writes(request.code);
  if (!data.covers(request.function->base, request.address, request.count, to_write))
    return modbus_exception_reply(request.code, modbus_exception::address);
  return to_write ? write(request, data) : read(request, data);
}

Bytes modbus_exception_reply(Byte code, Byte exception) {
  return {static_cast<Byte>(code | 0x80), exception};
}

}  // namespace fieldproof::modbus
