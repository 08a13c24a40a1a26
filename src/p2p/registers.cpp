#include "src/p2p/registers.hpp"

#include <fmt/format.h>

namespace fieldproof::p2p {

namespace {
constexpr std::uint32_t first_result = 512, words_a_result = 6;

plc::DeviceAddress address_in(const plc::PlcModel& model, char area, char type,
                              std::uint32_t index) {
  return {static_cast<std::uint8_t>(model.area(area) - model.areas.data()), type, false, index};
}

void write_name(plc::PlcMemory& memory, const plc::DeviceAddress& first, unsigned words,
                std::string_view name) {
  for (unsigned i = 0; i < words; ++i) {
    const auto letter = [name](std::size_t at) {
      return at < name.size() ? static_cast<unsigned char>(name[at]) : 0u;
    };
    memory.write(first + i, letter(2 * i + 1) << 8 | letter(2 * i));
  }
}

void write_block(plc::PlcMemory& memory, const P2pParameters& parameters, const P2pBlock& block) {
  const P2pRegisters registers = p2p_registers(memory.model(), parameters.parameter, block.number);
  memory.write(registers.station, parameters.network ? block.channel : block.station);
  const bool own_is_saved =
      block.function == P2pBlock::Function::read || block.function == P2pBlock::Function::receive;
  const unsigned bytes =
      block.is_user_frame() ? block.size : block.elements() * plc::type_bytes(block.type);
  for (std::size_t i = 0; i < p2p_max_variables; ++i) {
    const bool used = i < block.variables.size() && !block.is_mail();
    const std::string own = used ? device_name(memory.model(), block.variables[i].own) : "";
    const std::string partner = used ? block.variables[i].partner : "";
    const auto show = [&](const P2pRegisters::Area& area, const std::string& name) {
      write_name(memory, area.name, registers.name_words, name);
      memory.write(area.size, name.empty() ? 0 : bytes);
    };
    show(registers.read[i], own_is_saved ? partner : own);
    show(registers.save[i], own_is_saved ? own : partner);
  }
}
}  // namespace

P2pResultFlags p2p_result_flags(const plc::PlcModel& model, unsigned parameter, unsigned block) {
  const std::uint32_t word = first_result + words_a_result * (p2p_blocks * (parameter - 1) + block);
  return {.ndr = address_in(model, 'L', 'X', word * 16),
          .err = address_in(model, 'L', 'X', word * 16 + 1),
          .status = address_in(model, 'L', 'W', word + 1),
          .services = address_in(model, 'L', 'D', word / 2 + 1),
          .errors = address_in(model, 'L', 'D', word / 2 + 2)};
}

P2pRegisters p2p_registers(const plc::PlcModel& model, unsigned parameter, unsigned block) {
  P2pRegisters registers;
  registers.name_words = model.iec ? 5 : 4;
  const std::uint32_t words_an_area = registers.name_words + 1,
                      words_a_block = 1 + 2 * p2p_max_variables * words_an_area;
  std::uint32_t word = words_a_block * (p2p_blocks * (parameter - 1) + block);
  registers.station = address_in(model, 'N', 'W', word++);
  for (auto* areas : {&registers.read, &registers.save}) {
    for (P2pRegisters::Area& area : *areas) {
      area.name = address_in(model, 'N', 'W', word);
      area.size = area.name + registers.name_words;
      word += words_an_area;
    }
  }
  return registers;
}

void write_p2p_registers(plc::PlcMemory& memory, const P2pParameters& parameters) {
  for (const P2pBlock& block : parameters.blocks) write_block(memory, parameters, block);
}

std::string device_name(const plc::PlcModel& model, const plc::DeviceAddress& address) {
  const char area = model.areas[address.area].letter;
  if (address.type == 'X' && !address.contact && !model.iec) {
    return fmt::format("%{}X{}{:X}", area,
                       address.index / 16 == 0 ? "" : std::to_string(address.index / 16),
                       address.index % 16);
  }
  return fmt::format("%{}{}{}", area, address.type, address.index);
}

}  // namespace fieldproof::p2p
