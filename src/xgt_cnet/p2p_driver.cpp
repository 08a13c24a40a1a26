#include "src/xgt_cnet/p2p_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "src/base/letters.hpp"
#include "src/p2p/partner_name.hpp"

namespace fieldproof::xgt_cnet {

using p2p::P2pBlock;

namespace {
bool writes(const P2pBlock& block) { return block.function == P2pBlock::Function::write; }

std::size_t digits_of(const P2pBlock& block) {
  return std::size_t{2} * plc::type_bytes(block.type) * block.elements();
}

std::string digits_in(const plc::PlcMemory& memory, const P2pBlock& block,
                      const plc::DeviceAddress& first) {
  std::string digits;
  for (unsigned i = 0; i < block.elements(); ++i)
    digits += hex_number(memory.read(first + i), static_cast<int>(2 * plc::type_bytes(block.type)));
  return digits;
}

void save(plc::PlcMemory& memory, plc::DeviceAddress to, std::string_view digits) {
  const std::size_t size = std::size_t{2} * plc::type_bytes(to.type);
  for (; !digits.empty(); digits.remove_prefix(size), to = to + 1)
    memory.write(to, data_value(digits.substr(0, size)));
}

/// What is wrong with the data of a read, if anything.
std::uint16_t check_data(const XgtReply& reply, const P2pBlock& block, const plc::PlcModel& model) {
  if (reply.blocks != block.variables.size()) return p2p::p2p_error::length;
  const std::size_t due = digits_of(block), element = std::size_t{2} * plc::type_bytes(block.type);
  for (std::size_t i = 0; i < block.variables.size(); ++i) {
    const std::size_t digits = reply.data[i].size();
    if (digits == due) continue;
    const auto elements = static_cast<std::uint32_t>((digits + element - 1) / element);
    return plc::fits(model, block.variables[i].own, elements) ? p2p::p2p_error::length
                                                              : p2p::p2p_error::range;
  }
  return p2p::p2p_error::none;
}

std::uint16_t check_reply(const XgtReply& reply, const P2pBlock& block,
                          const plc::PlcModel& model) {
  if (reply.fault.check == XgtCheck::bcc) return p2p::p2p_error::bcc;
  if (reply.station != block.station) return p2p::p2p_error::station;
  const XgtService asked = service_of(writes(block) ? 'w' : 'r', block.continuous ? "SB" : "SS");
  if (!is_lower(reply.command) || service_of(reply.command, reply.kind) != asked)
    return p2p::p2p_error::driver;
  if (!reply.ack) return p2p::p2p_error::nak;
  if (reply.fault)
    return reply.fault.check == XgtCheck::data ? p2p::p2p_error::not_hex : p2p::p2p_error::length;
  return writes(block) ? p2p::p2p_error::none : check_data(reply, block, model);
}
}  // namespace

Status XgtP2pDriver::check(const P2pBlock& block, const plc::PlcModel&) const {
  if (const Status names = p2p::check_partner_names(block, xgt_max_name); !names) return names;
  if (!block.continuous) return ok();
  if (block.type == 'X')
    return fail("bits are not read or written as a run; use command single (Cnet KO 6.3.2)");
  const unsigned most = p2p::p2p_max_bytes / plc::type_bytes(block.type);
  if (block.size > most)
    return fail(fmt::format("size is {}; a run has at most {} bytes: {} elements of this type",
                            block.size, p2p::p2p_max_bytes, most));
  return ok();
}

Result<Bytes> XgtP2pDriver::request(const P2pBlock& block, const plc::PlcMemory& memory) {
  XgtRequest request{.station = block.station,
                     .command = writes(block) ? 'w' : 'r',
                     .kind = block.continuous ? "SB" : "SS"};
  request.content = service_of(request.command, request.kind);
  request.blocks = static_cast<unsigned>(block.variables.size());
  request.count = block.elements();
  std::array<std::string, p2p::p2p_max_variables> names, data;
  for (std::size_t i = 0; i < block.variables.size(); ++i) {
    names[i] = p2p::unpadded_name(block.variables[i].partner);
    if (writes(block)) data[i] = digits_in(memory, block, block.variables[i].own);
    request.block[i] = {names[i], data[i]};
  }
  Bytes bytes;
  encode_request(request, bytes);
  return bytes;
}

std::optional<std::uint16_t> XgtP2pDriver::take(const P2pBlock& block, ByteView frame,
                                                plc::PlcMemory& memory) const {
  const XgtReply reply = parse_reply(frame);
  const std::uint16_t error = check_reply(reply, block, memory.model());
  if (error != p2p::p2p_error::none) return error;
  std::size_t i = 0;  // what has been written comes back without data
  for (const p2p::P2pVariable& variable : block.variables)
    save(memory, variable.own, reply.data[i++]);
  return error;
}

}  // namespace fieldproof::xgt_cnet
