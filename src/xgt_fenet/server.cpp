#include "src/xgt_fenet/server.hpp"

#include "src/base/letters.hpp"
#include "src/plc/address.hpp"
#include "src/xgt_fenet/splitter.hpp"

namespace fieldproof::xgt_fenet {

using plc::AddressFault;

namespace {

// Table 5-3. The CPU type of XGB is not printed: DECISIONS.md fenet/plcinfo.
constexpr std::uint16_t cpu_type = 0x07, cpu_has_error = 1 << 7, state_run = 1 << 8,
                        state_stop = 2 << 8, state_error = 4 << 8;

std::uint64_t value_of(ByteView data) {
  std::uint64_t value = 0;
  for (std::size_t i = data.size(); i-- > 0;) value = value << 8 | data[i];
  return value;
}

bool is_letter(char c) { return upper(c) >= 'A' && upper(c) <= 'Z'; }

std::uint16_t fault_of_name(AddressFault fault, bool continuous) {
  switch (fault) {
    case AddressFault::none: return error::none;
    case AddressFault::percent:
    case AddressFault::form: return error::name;
    case AddressFault::area: return error::area;
    case AddressFault::type: return continuous ? error::continuous_letter : error::letter;
    case AddressFault::range: return error::range;
  }
  return error::name;
}

}  // namespace

std::unique_ptr<plc::StreamSplitter> FenetServer::new_splitter() const {
  return std::make_unique<FrameSplitter>();
}

std::optional<Bytes> FenetServer::answer(ByteView frame, std::uint16_t&) {
  const std::optional<Header> header = read_header(frame);
  if (!header) return std::nullopt;
  Request request = parse_request(frame.subspan(header_size));
  if (const std::uint16_t fault = fault_of(*header, frame)) request.fault = fault;
  return reply_frame(*header,
                     request.fault ? encode_refusal(request, request.fault) : execute(request));
}

/// What is wrong with the header. A frame out of a stream is as long as it says, a datagram may
/// not be.
std::uint16_t FenetServer::fault_of(const Header& header, ByteView frame) const {
  if (!header.is_known_company()) return error::company;
  const bool valid = header.check == header_check(frame);
  const bool taken = config_.check == CheckPolicy::ignore || valid ||
                     (config_.check == CheckPolicy::zero_or_valid && header.check == 0);
  if (!taken) return error::check;
  return frame.size() == header.frame_size() ? error::none : error::length;
}

/// Everything is checked before anything is done: a write is all or nothing.
Bytes FenetServer::execute(const Request& request) {
  Addresses addresses;
  if (const std::uint16_t fault = find_addresses(request, addresses))
    return encode_refusal(request, fault);
  std::vector<Bytes> data;
  for (std::size_t i = 0; i < addresses.size(); ++i) {
    const Request::Block& block = request.blocks[i];
    if (request.writes())
      write(addresses[i], block.data);
    else
      data.push_back(read(addresses[i], request.is_continuous() ? block.size : 1));
  }
  if (request.writes()) memory_.written();
  return encode_reply(request, data);
}

std::uint16_t FenetServer::find_addresses(const Request& request, Addresses& addresses) const {
  for (const Request::Block& block : request.blocks)
    if (const std::uint16_t fault = find_address(request, block, addresses.emplace_back()))
      return fault;
  for (const Request::Block& block : request.blocks) {
    const bool right = request.is_continuous() ? block.size > 0 && block.size <= most_bytes
                                               : block.size == plc::type_bytes(request.letter());
    if ((request.writes() || request.is_continuous()) && !right) return error::size;
  }
  return error::none;
}

std::uint16_t FenetServer::find_address(const Request& request, const Request::Block& block,
                                        plc::DeviceAddress& address) const {
  const plc::PlcModel& model = memory_.model();
  const plc::ParsedAddress parsed = plc::parse_address(model, block.name, true);
  if (parsed.fault == AddressFault::area && !is_letter(block.name[1])) return error::device;
  const bool lettered = parsed.address.type != 0;
  const std::uint16_t fault = fault_of_name(parsed.fault, request.is_continuous());
  if (lettered && parsed.address.type != request.letter())
    return fault_of_name(AddressFault::type, request.is_continuous());
  if (fault != error::none && fault != error::range) return fault;
  address = parsed.address;
  if (request.writes() && !model.areas[address.area].write) return error::area;
  if (fault != error::none) return fault;
  const unsigned elements = request.is_continuous() ? block.size : 1;
  return plc::fits(model, address, elements) ? error::none : error::range;
}

/// Low byte first.
Bytes FenetServer::read(const plc::DeviceAddress& first, unsigned elements) const {
  const unsigned size = plc::type_bytes(first.type);
  Bytes data;
  data.reserve(std::size_t{elements} * size);
  for (unsigned i = 0; i < elements; ++i) {
    const std::uint64_t value = memory_.read(first + i);
    for (unsigned b = 0; b < size; ++b) data.push_back(static_cast<Byte>(value >> (8 * b)));
  }
  return data;
}

void FenetServer::write(const plc::DeviceAddress& first, ByteView data) {
  const unsigned size = plc::type_bytes(first.type);
  for (unsigned i = 0; i * size < data.size(); ++i) {
    const std::uint64_t value = value_of(data.subspan(std::size_t{i} * size, size));
    memory_.write(first + i, value);
  }
}

Bytes FenetServer::reply_frame(const Header& request, ByteView body) const {
  return encode_frame({.company = request.is_known_company() ? request.company : lsis_xgt,
                       .plc_info = plc_info(),
                       .cpu_info = memory_.model().iec ? cpu_xgb_iec : cpu_xgb,
                       .source = from_server,
                       .invoke = request.invoke,
                       .position = static_cast<Byte>(config_.base << 4 | config_.slot)},
                      body);
}

std::uint16_t FenetServer::plc_info() const {
  if (config_.cpu_error) return cpu_type | cpu_has_error | state_error;
  return cpu_type | (run_ ? state_run : state_stop);
}

}  // namespace fieldproof::xgt_fenet
