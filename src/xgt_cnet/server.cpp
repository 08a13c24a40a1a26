#include "src/xgt_cnet/server.hpp"

#include <algorithm>

#include "src/plc/address.hpp"

namespace fieldproof::xgt_cnet {

using plc::AddressFault;

namespace {
constexpr std::size_t most_digits = 16;  // of one element: an lword

bool writes(XgtService content) {
  return content == XgtService::write_blocks || content == XgtService::write_run;
}

XgtFault name_fault(AddressFault fault) {
  switch (fault) {
    case AddressFault::percent: return {XgtCheck::percent, xgt_error::data};
    case AddressFault::area: return {XgtCheck::area, xgt_error::area};
    case AddressFault::type: return {XgtCheck::type, xgt_error::type};
    case AddressFault::form: return {XgtCheck::number_form, xgt_error::data};
    case AddressFault::range: return {XgtCheck::range, xgt_error::range};
    case AddressFault::none: break;
  }
  return {};
}

/// A registration number as it stands in the reply: upper-case hex; what is no digit as it was
/// sent, but such that the reply keeps its form.
std::string_view replied_number(std::string_view sent, std::array<char, 2>& number) {
  number = {'0', '0'};
  std::ranges::transform(sent, number.begin(), [](char c) {
    if (hex_digit(c) >= 0) return hex_char(static_cast<unsigned>(hex_digit(c)));
    return c > ' ' && c < '\x7F' ? c : '0';
  });
  return {number.data(), number.size()};
}
}  // namespace

XgtServer::XgtServer(plc::PlcMemory& memory, unsigned station, Duration gap, Duration delay)
    : memory_(memory),
      station_(station),
      delay_(delay),
      receiver_(FrameReceiver::Side::server, gap) {}

Bytes XgtServer::advance(Time now) {
  receiver_.advance(now, *this);
  return replies_.take(now);
}

void XgtServer::power_cycle() {
  registrations_ = {};
  counters_ = {};
  replies_.clear();
  receiver_.reset();
}

void XgtServer::on_frame(ByteView frame, Time end) {
  XgtRequest request = parse_request(frame);
  const XgtCheck check = request.fault.check;
  if (check == XgtCheck::bcc) return counters_.count_error(plc::service_status::bcc);
  if (request.station != station_) return counters_.count_error(plc::service_status::station);
  if (check == XgtCheck::command) return counters_.count_error(plc::service_status::head);

  Addresses addresses;
  check_names(request, addresses);
  XgtReply reply{.station = request.station, .command = request.command, .kind = request.kind};
  std::array<char, 2> number;
  const bool numbered =
      request.service == XgtService::register_monitor || request.service == XgtService::run_monitor;
  if (numbered) reply.kind = replied_number(request.kind, number);
  if (request.fault) {
    reply.ack = false;
    reply.error = request.fault.code;
  } else {
    execute(request, addresses, reply);
  }
  Bytes bytes;
  encode_reply(reply, bytes);
  replies_.put(end + delay_, std::move(bytes));
  counters_.count_service();
}

/// What only the model can tell of the names, and for Y whether there is a registration.
void XgtServer::check_names(XgtRequest& request, Addresses& addresses) const {
  if (request.service == XgtService::run_monitor) {
    if (registrations_[request.registration].content == XgtService::unknown)
      request.fault.note({XgtCheck::registered, xgt_error::not_registered});
    return;
  }
  const plc::PlcModel& model = memory_.model();
  for (unsigned i = 0; i < request.blocks; ++i) {
    const plc::ParsedAddress parsed = plc::parse_address(model, request.block[i].name);
    addresses[i] = parsed.address;
    request.fault.note(name_fault(parsed.fault));
    if (writes(request.content) && !model.areas[parsed.address.area].write)
      request.fault.note({XgtCheck::area, xgt_error::area});
    if (addresses[i].type != addresses[0].type)
      request.fault.note({XgtCheck::equal_types, xgt_error::mixed_types});
    if (!plc::fits(model, parsed.address, request.count))
      request.fault.note({XgtCheck::range, xgt_error::range});
  }
}

void XgtServer::execute(const XgtRequest& request, const Addresses& addresses, XgtReply& reply) {
  switch (request.service) {
    case XgtService::read_blocks:
      return read_blocks(std::span(addresses).first(request.blocks), reply);
    case XgtService::read_run:
      reply.with_block_count = true;
      return add_data(addresses[0], request.count, reply);
    case XgtService::register_monitor: {
      Registration& r = registrations_[request.registration];
      r.content = request.content;
      r.addresses.assign(addresses.begin(), addresses.begin() + request.blocks);
      r.count = request.count;
      return;
    }
    case XgtService::run_monitor: {
      const Registration& r = registrations_[request.registration];
      return r.content == XgtService::read_run ? add_data(r.addresses[0], r.count, reply)
                                               : read_blocks(r.addresses, reply);
    }
    default: return write(request, addresses);
  }
}

void XgtServer::read_blocks(std::span<const plc::DeviceAddress> addresses, XgtReply& reply) {
  reply.with_block_count = true;
  for (const plc::DeviceAddress& address : addresses) add_data(address, 1, reply);
}

void XgtServer::add_data(const plc::DeviceAddress& first, unsigned count, XgtReply& reply) {
  char* const begin = data_.data() + reply.blocks * most_digits;
  char* end = begin;
  for (unsigned i = 0; i < count; ++i) {
    const std::uint64_t value = memory_.read(first + i);
    for (unsigned d = 2 * plc::type_bytes(first.type); d-- > 0;)
      *end++ = hex_char(static_cast<unsigned>(value >> (4 * d)));
  }
  reply.data[reply.blocks++] = {begin, end};
}

/// Everything has been checked: a write is all or nothing.
void XgtServer::write(const XgtRequest& request, const Addresses& addresses) {
  const std::size_t digits = 2 * plc::type_bytes(addresses[0].type);
  for (unsigned i = 0; i < request.count; ++i)
    memory_.write(addresses[0] + i, data_value(request.block[0].data.substr(i * digits, digits)));
  if (request.content == XgtService::write_blocks) {
    for (unsigned i = 0; i < request.blocks; ++i)
      memory_.write(addresses[i], data_value(request.block[i].data));
  }
  memory_.written();
}

}  // namespace fieldproof::xgt_cnet
