#include "src/xgt_fenet/p2p_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>

#include "src/p2p/partner_name.hpp"
#include "src/xgt_fenet/client_body.hpp"

namespace fieldproof::xgt_fenet {

using p2p::P2pBlock;

namespace {

constexpr std::size_t longest_index = 7;  // digits; no area has so many elements

bool writes(const P2pBlock& block) { return block.function == P2pBlock::Function::write; }

std::uint16_t type_of(const P2pBlock& block) {
  return block.continuous ? continuous_type
                          : static_cast<std::uint16_t>(std::string_view("XBWDL").find(block.type));
}

/// What a block carries from or to one variable.
std::size_t bytes_of(const P2pBlock& block) {
  return std::size_t{block.elements()} * plc::type_bytes(block.type);
}

/// Of a name as it is sent: the index of its element, if it is a decimal number.
std::optional<unsigned> index_of(std::string_view name) {
  const std::string_view digits = name.substr(3);
  unsigned index = 0;
  const auto [end, fault] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  if (digits.size() > longest_index || fault != std::errc() || end != digits.data() + digits.size())
    return std::nullopt;
  return index;
}

/// A run is named by its first byte.
std::string name_of(const P2pBlock& block, const p2p::P2pVariable& variable) {
  const std::string name = p2p::unpadded_name(variable.partner);
  if (!block.continuous) return name;
  return fmt::format("%{}B{}", name[1], *index_of(name) * plc::type_bytes(block.type));
}

/// Low byte first.
Bytes values_in(const plc::PlcMemory& memory, const P2pBlock& block,
                const plc::DeviceAddress& first) {
  Bytes bytes;
  for (unsigned i = 0; i < block.elements(); ++i) {
    const std::uint64_t value = memory.read(first + i);
    for (unsigned b = 0; b < plc::type_bytes(block.type); ++b)
      bytes.push_back(static_cast<Byte>(value >> 8 * b));
  }
  return bytes;
}

void save(plc::PlcMemory& memory, plc::DeviceAddress to, ByteView bytes) {
  const unsigned size = plc::type_bytes(to.type);
  for (; !bytes.empty(); bytes = bytes.subspan(size), to = to + 1) {
    std::uint64_t value = 0;
    for (unsigned b = size; b-- > 0;) value = value << 8 | bytes[b];
    memory.write(to, value);
  }
}

/// What is wrong with the data of a read, if anything.
std::uint16_t check_data(const Reply& reply, const P2pBlock& block, const plc::PlcModel& model) {
  const std::size_t due = bytes_of(block), element = plc::type_bytes(block.type);
  for (std::size_t i = 0; i < block.variables.size(); ++i) {
    const std::size_t size = reply.data[i].size();
    if (size == due) continue;
    const auto elements = static_cast<std::uint32_t>((size + element - 1) / element);
    return plc::fits(model, block.variables[i].own, elements) ? p2p::p2p_error::length
                                                              : p2p::p2p_error::range;
  }
  return p2p::p2p_error::none;
}

std::uint16_t check_reply(ByteView body, const std::optional<Reply>& reply, const P2pBlock& block,
                          const plc::PlcModel& model) {
  const std::uint16_t command = (writes(block) ? write_command : read_command) + 1;
  const bool other = body.size() >= 4 && (word_at(body, 0) != command ||  //
                                          word_at(body, 2) != type_of(block));
  if (other) return p2p::p2p_error::driver;
  if (!reply) return p2p::p2p_error::length;
  if (reply->refused) return *reply->refused != 0 ? *reply->refused : p2p::p2p_error::nak;
  if (reply->blocks != block.variables.size()) return p2p::p2p_error::length;
  return writes(block) ? p2p::p2p_error::none : check_data(*reply, block, model);
}

}  // namespace

Status FenetP2pDriver::check(const P2pBlock& block, const plc::PlcModel&) const {
  if (const Status names = p2p::check_partner_names(block, longest_name); !names) return names;
  if (!block.continuous) return ok();
  if (block.type == 'X')
    return fail("bits are not read or written as a run; use command single (FEnet EN 5.2.4)");
  const std::string& first = block.variables.front().partner;
  if (!index_of(p2p::unpadded_name(first)))
    return fail(
        fmt::format("{} '{}' has no decimal number; a run is asked for by bytes: give one "
                    "such as %MW100",
                    writes(block) ? "save" : "read", first));
  if (bytes_of(block) > most_bytes)
    return fail(fmt::format("size is {}; a run has at most {} bytes: {} elements of this type",
                            block.size, most_bytes, most_bytes / plc::type_bytes(block.type)));
  return ok();
}

Result<Bytes> FenetP2pDriver::request(const P2pBlock& block, const plc::PlcMemory& memory) {
  std::array<std::string, p2p::p2p_max_variables> names;
  std::array<Bytes, p2p::p2p_max_variables> data;
  Request request{.command = writes(block) ? write_command : read_command,
                  .type = type_of(block),
                  .blocks = {}};
  for (std::size_t i = 0; i < block.variables.size(); ++i) {
    names[i] = name_of(block, block.variables[i]);
    if (writes(block)) data[i] = values_in(memory, block, block.variables[i].own);
    request.blocks.push_back({names[i], static_cast<std::uint16_t>(bytes_of(block)), data[i]});
  }
  const Byte cpu = memory.model().iec ? cpu_xgb_iec : cpu_xgb;
  return encode_frame({.cpu_info = cpu, .invoke = ++invoke_}, encode_request(request));
}

bool FenetP2pDriver::is_reply(const Header& header) const {
  return header.company == lsis_xgt && header.source == from_server && header.invoke == invoke_;
}

std::optional<std::uint16_t> FenetP2pDriver::take(const P2pBlock& block, ByteView frame,
                                                  plc::PlcMemory& memory) const {
  const std::optional<Header> header = read_header(frame);
  if (!header || !is_reply(*header)) return std::nullopt;
  if (frame.size() != header->frame_size()) return p2p::p2p_error::length;
  const ByteView body = frame.subspan(header_size);
  const std::optional<Reply> reply = parse_reply(body);
  const std::uint16_t error = check_reply(body, reply, block, memory.model());
  if (error == p2p::p2p_error::none && !writes(block)) {
    for (std::size_t i = 0; i < block.variables.size(); ++i)
      save(memory, block.variables[i].own, reply->data[i]);
  }
  return error;
}

void FenetP2pDriver::receive(const Burst& burst, plc::FrameSink& sink) {
  if (burst.event == LinkEvent::datagram)
    sink.on_frame(burst.bytes, burst.end());
  else
    splitter_.receive(burst, sink);
}

}  // namespace fieldproof::xgt_fenet
