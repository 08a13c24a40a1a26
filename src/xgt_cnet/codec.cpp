#include "src/xgt_cnet/codec.hpp"

#include <algorithm>
#include <charconv>

#include "src/plc/address.hpp"

namespace fieldproof::xgt_cnet {

namespace {
std::string_view as_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool all_hex(std::string_view digits) {
  return std::ranges::all_of(digits, [](char c) { return hex_digit(c) >= 0; });
}

/// Takes fields off the front of a text.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : text_(text) {}

  std::size_t left() const { return text_.size(); }
  /// Shorter than asked for when the text ends before.
  std::string_view take(std::size_t size) {
    const std::string_view field = text_.substr(0, size);
    text_.remove_prefix(field.size());
    return field;
  }
  /// One character, or 0 at the end.
  char letter() {
    const std::string_view field = take(1);
    return field.empty() ? '\0' : field[0];
  }
  /// So many hex digits, or -1.
  std::int64_t number(std::size_t digits = 2) {
    const std::string_view field = take(digits);
    return field.size() == digits ? hex_value(field) : -1;
  }

 private:
  std::string_view text_;
};

/// Header, station, command, tail and BCC of a request or a reply; leaves the content between them.
struct Envelope {
  XgtFault fault;
  unsigned station = 0;
  char command = 0;
  std::string_view kind;
  Cursor content{std::string_view{}};
};

Envelope open_envelope(ByteView frame, bool right_head, Byte tail_byte) {
  Envelope e;
  if (!right_head) e.fault.note({XgtCheck::head});
  const std::string_view text = as_text(frame);
  const std::size_t tail = std::min(text.find(static_cast<char>(tail_byte)), text.size());
  if (tail == text.size()) e.fault.note({XgtCheck::tail});
  Cursor in(text.substr(0, tail));
  in.letter();
  const std::int64_t station = in.number();
  if (station < 0) e.fault.note({XgtCheck::station});
  e.station = static_cast<unsigned>(station);  // of no device, then
  e.command = in.letter();
  e.kind = in.take(2);
  e.content = in;
  // Hex digits are accepted in either case (7.1.3 Note: only the main command tells the cases
  // apart).
  if (is_lower(e.command)) {
    Cursor behind(text);
    const std::string_view summed = behind.take(tail + 1);
    if (behind.number() != xgt_bcc(frame.first(summed.size()))) e.fault.note({XgtCheck::bcc});
  }
  return e;
}

/// What stands between the type of a request and its tail. A fault may make nonsense of all that
/// follows: what is looked at later never hides it.
class ContentReader {
 public:
  ContentReader(Cursor content, XgtRequest& request) : in_(content), request_(request) {}

  void read() {
    if (request_.service == XgtService::register_monitor)
      read_registration();
    else if (request_.service != XgtService::run_monitor)
      read_content();
    if (in_.left() > 0) note(XgtCheck::surplus, xgt_error::surplus);
  }

 private:
  void note(XgtCheck check, std::uint16_t code) { request_.fault.note({check, code}); }

  /// Two hex digits, or -1 with the fault noted.
  int number(XgtCheck check) {
    const std::int64_t value = in_.number();
    if (value < 0) note(check, xgt_error::data);
    return static_cast<int>(value);
  }

  void read_registration() {
    const char command = in_.letter();
    request_.content = service_of(command, in_.take(2));
    if (request_.content != XgtService::read_blocks && request_.content != XgtService::read_run)
      return note(XgtCheck::registration_content, xgt_error::data);
    read_content();
  }

  void read_content() {
    const bool write =
        request_.content == XgtService::write_blocks || request_.content == XgtService::write_run;
    const bool run =
        request_.content == XgtService::read_run || request_.content == XgtService::write_run;
    if (run)
      read_run(write);
    else
      read_blocks(write);
  }

  void read_blocks(bool write) {
    const int blocks = number(XgtCheck::block_count);
    if (blocks == 0) note(XgtCheck::block_count, xgt_error::data);
    if (blocks > static_cast<int>(xgt_max_blocks))
      return note(XgtCheck::block_count, xgt_error::blocks);
    for (int i = 0; i < blocks; ++i) {
      XgtBlock& block = request_.block[request_.blocks++];
      read_name(block);
      if (!write) continue;
      if (element_bytes(block) == 0) return;  // where the next block begins cannot be told
      read_data(block, 1);
      if (type_of(block) == 'X' && hex_value(block.data) > 1)
        note(XgtCheck::bit_value, xgt_error::data);
    }
  }

  void read_run(bool write) {
    XgtBlock& block = request_.block[0];
    read_name(block);
    request_.blocks = 1;
    if (type_of(block) == 'X') note(XgtCheck::type, xgt_error::type);
    const int count = number(XgtCheck::count);
    request_.count = static_cast<unsigned>(count);  // no number: more than there is
    if (count == 0) note(XgtCheck::count, xgt_error::data);
    if (request_.count * element_bytes(block) > xgt_max_run) note(XgtCheck::count, xgt_error::size);
    if (write) read_data(block, request_.count);
  }

  void read_name(XgtBlock& block) {
    const int length = number(XgtCheck::name_length);
    if (length == 0 || length > static_cast<int>(xgt_max_name))
      note(XgtCheck::name_length, xgt_error::name_length);
    block.name = in_.take(static_cast<std::size_t>(length));
    if (block.name.size() < static_cast<std::size_t>(length))
      note(XgtCheck::name_length, xgt_error::data);
  }

  static char type_of(const XgtBlock& block) {
    return block.name.size() > 2 ? upper(block.name[2]) : '\0';
  }
  static unsigned element_bytes(const XgtBlock& block) { return plc::type_bytes(type_of(block)); }

  void read_data(XgtBlock& block, unsigned elements) {
    const std::size_t digits = std::size_t{2} * elements * element_bytes(block);
    block.data = in_.take(digits);
    if (block.data.size() < digits) note(XgtCheck::data, xgt_error::data);
    if (!all_hex(block.data)) note(XgtCheck::data, xgt_error::not_hex);
  }

  Cursor in_;
  XgtRequest& request_;
};

void append(Bytes& out, std::string_view text) { out.insert(out.end(), text.begin(), text.end()); }

void append_number(Bytes& out, std::size_t value) {
  out.push_back(static_cast<Byte>(hex_char(static_cast<unsigned>(value) >> 4)));
  out.push_back(static_cast<Byte>(hex_char(static_cast<unsigned>(value))));
}

void begin_frame(Bytes& out, Byte head, unsigned station, char command, std::string_view kind) {
  out.push_back(head);
  append_number(out, station);
  out.push_back(static_cast<Byte>(command));
  append(out, kind);
}

void end_frame(Bytes& out, std::size_t begin, Byte tail, bool with_bcc) {
  out.push_back(tail);
  if (with_bcc) append_number(out, xgt_bcc(ByteView(out).subspan(begin)));
}

void append_name(Bytes& out, std::string_view name) {
  append_number(out, name.size());
  append(out, name);
}
}  // namespace

XgtService service_of(char command, std::string_view type) {
  if (type.size() != 2 || upper(type[0]) != 'S') return XgtService::unknown;
  const char last = upper(type[1]);
  if (last != 'S' && last != 'B') return XgtService::unknown;
  if (upper(command) == 'R') return last == 'S' ? XgtService::read_blocks : XgtService::read_run;
  if (upper(command) == 'W') return last == 'S' ? XgtService::write_blocks : XgtService::write_run;
  return XgtService::unknown;
}

std::int64_t hex_value(std::string_view digits) {
  return all_hex(digits) ? static_cast<std::int64_t>(data_value(digits)) : -1;
}

std::uint64_t data_value(std::string_view digits) {
  std::uint64_t value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  return value;
}

Byte xgt_bcc(ByteView header_to_tail) {
  unsigned sum = 0;
  for (const Byte b : header_to_tail) sum += b;
  return static_cast<Byte>(sum);
}

XgtRequest parse_request(ByteView frame) {
  XgtRequest request;
  const bool right_head = as_text(frame).starts_with(static_cast<char>(xgt_enq));
  const Envelope e = open_envelope(frame, right_head, xgt_eot);
  request.fault = e.fault;
  request.station = e.station;
  request.command = e.command;
  request.kind = e.kind;
  const char command = upper(e.command);
  if (command == 'X' || command == 'Y') {
    request.service = command == 'X' ? XgtService::register_monitor : XgtService::run_monitor;
    const std::int64_t number = Cursor(e.kind).number();
    if (number >= 0 && number < xgt_registrations) {
      request.registration = static_cast<unsigned>(number);
    } else {
      request.fault.note({XgtCheck::registration_number,
                          command == 'X' ? xgt_error::register_number : xgt_error::execute_number});
    }
  } else {
    request.service = request.content = service_of(e.command, e.kind);
    if (request.service == XgtService::unknown) request.fault.note({XgtCheck::command});
  }
  ContentReader(e.content, request).read();
  return request;
}

void encode_request(const XgtRequest& request, Bytes& out) {
  const std::size_t begin = out.size();
  begin_frame(out, xgt_enq, request.station, request.command, request.kind);
  if (request.service == XgtService::register_monitor)
    append(out, request.content == XgtService::read_run ? "RSB" : "RSS");
  const bool run =
      request.content == XgtService::read_run || request.content == XgtService::write_run;
  if (run) {
    append_name(out, request.block[0].name);
    append_number(out, request.count);
    append(out, request.block[0].data);
  } else if (request.service != XgtService::run_monitor) {
    append_number(out, request.blocks);
    for (unsigned i = 0; i < std::min(request.blocks, xgt_max_blocks); ++i) {
      append_name(out, request.block[i].name);
      append(out, request.block[i].data);
    }
  }
  end_frame(out, begin, xgt_eot, request.has_bcc());
}

namespace {
/// One block of a reply: byte count and data.
void read_reply_block(Cursor& in, XgtReply& reply) {
  const std::size_t digits = 2 * static_cast<std::size_t>(in.number());  // no number: endless
  const std::string_view data = in.take(digits);
  if (data.size() < digits) reply.fault.note({XgtCheck::count});
  if (!all_hex(data)) reply.fault.note({XgtCheck::data});
  reply.data[reply.blocks++] = data;
}

void read_reply_blocks(Cursor& in, XgtReply& reply) {
  reply.with_block_count = true;
  const std::int64_t blocks = in.number();
  if (blocks < 1 || blocks > xgt_max_blocks) return reply.fault.note({XgtCheck::block_count});
  for (std::int64_t i = 0; i < blocks; ++i) read_reply_block(in, reply);
}

/// The data of a run without a block count.
bool is_bare_run(Cursor in) {
  const std::size_t digits = 2 * static_cast<std::size_t>(in.number());
  return in.left() == digits;
}

void read_ack(Cursor& in, XgtReply& reply) {
  const char command = upper(reply.command);
  if (command == 'Y' && is_bare_run(in))
    read_reply_block(in, reply);
  else if (command == 'R' || command == 'Y')
    read_reply_blocks(in, reply);
}

void read_nak(Cursor& in, XgtReply& reply) {
  const std::string_view code = in.take(4);
  if (code.size() < 4) reply.fault.note({XgtCheck::count});
  if (!all_hex(code)) reply.fault.note({XgtCheck::data});
  reply.error = static_cast<std::uint16_t>(data_value(code));
}
}  // namespace

XgtReply parse_reply(ByteView frame) {
  XgtReply reply;
  const std::string_view text = as_text(frame);
  reply.ack = !text.starts_with(static_cast<char>(xgt_nak));
  const bool right_head = !reply.ack || text.starts_with(static_cast<char>(xgt_ack));
  const Envelope e = open_envelope(frame, right_head, xgt_etx);
  reply.fault = e.fault;
  reply.station = e.station;
  reply.command = e.command;
  reply.kind = e.kind;
  const char command = upper(e.command);
  const bool numbered = command == 'X' || command == 'Y';
  if (numbered ? Cursor(e.kind).number() < 0 : service_of(e.command, e.kind) == XgtService::unknown)
    reply.fault.note({XgtCheck::command});
  Cursor in = e.content;
  if (reply.ack)
    read_ack(in, reply);
  else
    read_nak(in, reply);
  if (in.left() > 0) reply.fault.note({XgtCheck::surplus});
  return reply;
}

void encode_reply(const XgtReply& reply, Bytes& out) {
  const std::size_t begin = out.size();
  begin_frame(out, reply.ack ? xgt_ack : xgt_nak, reply.station, reply.command, reply.kind);
  if (!reply.ack) {
    append_number(out, reply.error >> 8);
    append_number(out, reply.error);
  }
  if (reply.with_block_count) append_number(out, reply.blocks);
  for (unsigned i = 0; i < std::min(reply.blocks, xgt_max_blocks); ++i) {
    append_number(out, reply.data[i].size() / 2);
    append(out, reply.data[i]);
  }
  end_frame(out, begin, xgt_etx, reply.has_bcc());
}

}  // namespace fieldproof::xgt_cnet
