#include "src/xgt_cnet/codec.hpp"

#include <algorithm>

#include "src/base/letters.hpp"
#include "src/plc/address.hpp"

namespace fieldproof::xgt_cnet {

namespace {
constexpr std::size_t first_of_content = 6;  // header, station, command, type or number

std::string_view as_text(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool all_hex(std::string_view digits) {
  return std::ranges::all_of(digits, [](char c) { return hex_digit(c) >= 0; });
}

/// Takes fields off the front of a frame's content.
class Cursor {
 public:
  Cursor(std::string_view text, std::size_t offset) : text_(text), offset_(offset) {}

  std::size_t offset() const { return offset_; }
  std::size_t left() const { return text_.size(); }
  /// Shorter than asked for when the frame ends before.
  std::string_view take(std::size_t size) {
    const std::string_view field = text_.substr(0, size);
    text_.remove_prefix(field.size());
    offset_ += field.size();
    return field;
  }

 private:
  std::string_view text_;
  std::size_t offset_;
};

XgtService service_of(char command, std::string_view type) {
  if (type.size() != 2 || upper(type[0]) != 'S') return XgtService::unknown;
  const char last = upper(type[1]);
  if (last != 'S' && last != 'B') return XgtService::unknown;
  if (upper(command) == 'R') return last == 'S' ? XgtService::read_blocks : XgtService::read_run;
  if (upper(command) == 'W') return last == 'S' ? XgtService::write_blocks : XgtService::write_run;
  return XgtService::unknown;
}

/// Header, station, command, tail and BCC of a request or a reply; leaves the content between them.
struct Envelope {
  XgtFault fault;
  unsigned station = 0;
  char command = 0;
  std::string_view kind;
  Cursor content{{}, 0};
};

XgtFault check_bcc(ByteView frame, std::size_t tail) {
  const std::string_view bcc = as_text(frame).substr(tail + 1, 2);
  if (bcc.size() < 2) return {XgtCheck::bcc, 0, "BCC", "is missing", 0, tail + 1};
  // Hex digits are accepted in either case (7.1.3 Note: only the main command tells the cases
  // apart).
  if (hex_value(bcc) != xgt_bcc(frame.first(tail + 1)))
    return {XgtCheck::bcc, 0, "BCC", "is wrong", 0, tail + 1};
  return {};
}

Envelope open_envelope(ByteView frame, bool request) {
  Envelope e;
  const std::string_view text = as_text(frame);
  const bool head = !frame.empty() &&
                    (request ? frame[0] == xgt_enq : frame[0] == xgt_ack || frame[0] == xgt_nak);
  if (!head)
    e.fault.note({XgtCheck::head, 0, "header", request ? "is not ENQ" : "is not ACK or NAK", 0, 0});
  const std::size_t tail =
      std::min(text.find(static_cast<char>(request ? xgt_eot : xgt_etx)), text.size());
  if (tail == text.size())
    e.fault.note(
        {XgtCheck::tail, 0, "tail", request ? "EOT is missing" : "ETX is missing", 0, tail});
  const std::string_view body = text.substr(0, tail);
  const auto field = [body](std::size_t at, std::size_t size) {
    return body.substr(std::min(at, body.size()), size);
  };

  const std::string_view station = field(1, 2);
  const std::int64_t number = hex_value(station);
  if (station.size() < 2 || number < 0)
    e.fault.note({XgtCheck::station, 0, "station", "is not two hex digits", 0, 1});
  else
    e.station = static_cast<unsigned>(number);

  e.command = body.size() > 3 ? body[3] : '\0';
  e.kind = field(4, 2);
  if (e.command >= 'a' && e.command <= 'z' && tail < text.size())
    e.fault.note(check_bcc(frame, tail));
  e.content = Cursor(field(first_of_content, std::string_view::npos), first_of_content);
  return e;
}

/// What stands between the type of a request and its tail.
class ContentReader {
 public:
  ContentReader(Cursor content, XgtRequest& request) : in_(content), request_(request) {}

  void read() {
    switch (request_.service) {
      case XgtService::register_monitor: return read_registration();
      case XgtService::run_monitor: return check_surplus();
      default: return read_content();
    }
  }

 private:
  void wrong(XgtCheck check, std::uint16_t code, std::string_view field, std::string_view problem,
             std::size_t offset) {
    request_.fault.note({check, code, field, problem, block_, offset});
  }

  /// Two hex digits, or -1 with the fault noted.
  int number(XgtCheck check, std::string_view field) {
    const std::size_t offset = in_.offset();
    const std::string_view digits = in_.take(2);
    const std::int64_t value = digits.size() < 2 ? -1 : hex_value(digits);
    if (value >= 0) return static_cast<int>(value);
    wrong(check, xgt_error::data, field, digits.size() < 2 ? "is cut short" : "is not hex", offset);
    return -1;
  }

  void read_registration() {
    const std::size_t offset = in_.offset();
    const std::string_view what = in_.take(3);
    request_.content = what.size() == 3 && upper(what[0]) == 'R' ? service_of('R', what.substr(1))
                                                                 : XgtService::unknown;
    if (request_.content == XgtService::unknown) {
      return wrong(XgtCheck::registration_content, xgt_error::data, "registration format",
                   "is neither RSS nor RSB", offset);
    }
    read_content();
  }

  void read_content() {
    const bool write =
        request_.content == XgtService::write_blocks || request_.content == XgtService::write_run;
    const bool run =
        request_.content == XgtService::read_run || request_.content == XgtService::write_run;
    if (run ? read_run(write) : read_blocks(write)) check_surplus();
  }

  /// False when the rest of the frame cannot be told apart any more.
  bool read_blocks(bool write) {
    const std::size_t offset = in_.offset();
    const int blocks = number(XgtCheck::block_count, "block count");
    const bool too_many = blocks > static_cast<int>(xgt_max_blocks);
    if (blocks == 0)
      wrong(XgtCheck::block_count, xgt_error::data, "block count", "is zero", offset);
    if (too_many)
      wrong(XgtCheck::block_count, xgt_error::blocks, "block count", "is more than 16", offset);
    if (blocks <= 0 || too_many) return false;
    for (block_ = 1; block_ <= static_cast<unsigned>(blocks); ++block_) {
      XgtBlock& block = request_.block[block_ - 1];
      if (!read_name(block)) return false;
      request_.blocks = block_;
      if (!write) continue;
      const unsigned bytes = element_bytes(block);
      if (bytes == 0 || !read_data(block, bytes * 2)) return false;
      check_bit(block);
    }
    block_ = 0;
    return true;
  }

  bool read_run(bool write) {
    XgtBlock& block = request_.block[0];
    if (!read_name(block)) return false;
    request_.blocks = 1;
    const unsigned bytes = element_bytes(block);
    if (block.name.size() > 2 && upper(block.name[2]) == 'X') {
      const std::size_t name_offset = in_.offset() - block.name.size();
      wrong(XgtCheck::type, xgt_error::type, "name",
            "is of bits, which have no continuous read or write", name_offset);
    }
    const std::size_t offset = in_.offset();
    const int count = number(XgtCheck::count, "number of data");
    if (count < 0) return false;
    request_.count = static_cast<unsigned>(count);
    if (count == 0) wrong(XgtCheck::count, xgt_error::data, "number of data", "is zero", offset);
    if (request_.count * bytes > xgt_max_run) {
      wrong(XgtCheck::count, xgt_error::size, "number of data", "is more than 60 words", offset);
    }
    if (!write) return true;
    return bytes != 0 && read_data(block, std::size_t{request_.count} * bytes * 2);
  }

  bool read_name(XgtBlock& block) {
    const std::size_t offset = in_.offset();
    const int length = number(XgtCheck::name_length, "name length");
    const bool too_long = length > static_cast<int>(xgt_max_name);
    if (length == 0)
      wrong(XgtCheck::name_length, xgt_error::name_length, "name length", "is zero", offset);
    if (too_long)
      wrong(XgtCheck::name_length, xgt_error::name_length, "name length", "is more than 16",
            offset);
    if (length <= 0 || too_long) return false;
    const std::size_t name_offset = in_.offset();
    block.name = in_.take(static_cast<std::size_t>(length));
    if (block.name.size() == static_cast<std::size_t>(length)) return true;
    wrong(XgtCheck::name_length, xgt_error::data, "name", "is cut short", name_offset);
    return false;
  }

  static unsigned element_bytes(const XgtBlock& block) {
    return block.name.size() > 2 ? plc::type_bytes(block.name[2]) : 0;
  }

  bool read_data(XgtBlock& block, std::size_t digits) {
    const std::size_t offset = in_.offset();
    block.data = in_.take(digits);
    if (block.data.size() < digits) {
      wrong(XgtCheck::data, xgt_error::data, "data", "is cut short", offset);
      return false;
    }
    if (!all_hex(block.data))
      wrong(XgtCheck::data, xgt_error::not_hex, "data", "is not hex", offset);
    return true;
  }

  void check_bit(const XgtBlock& block) {
    if (upper(block.name[2]) != 'X' || hex_value(block.data) == 0 || hex_value(block.data) == 1)
      return;
    wrong(XgtCheck::bit_value, xgt_error::data, "data", "is not 00 or 01",
          in_.offset() - block.data.size());
  }

  void check_surplus() {
    block_ = 0;
    if (in_.left() > 0)
      wrong(XgtCheck::surplus, xgt_error::surplus, "surplus", "follows the last field",
            in_.offset());
  }

  Cursor in_;
  XgtRequest& request_;
  unsigned block_ = 0;
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

std::string describe(const XgtFault& fault) {
  if (!fault) return "the frame is right";
  std::string text = fault.block > 0 ? "block " + std::to_string(fault.block) + ", " : "";
  text += std::string(fault.field) + ' ' + std::string(fault.problem);
  if (fault.code != 0) text += " (NAK " + hex_number(fault.code, 4) + ')';
  return text;
}

std::int64_t hex_value(std::string_view digits) {
  if (digits.empty()) return -1;
  std::int64_t value = 0;
  for (const char c : digits) {
    const int digit = hex_digit(c);
    if (digit < 0) return -1;
    value = value << 4 | digit;
  }
  return value;
}

Byte xgt_bcc(ByteView header_to_tail) {
  unsigned sum = 0;
  for (const Byte b : header_to_tail) sum += b;
  return static_cast<Byte>(sum);
}

XgtRequest parse_request(ByteView frame) {
  XgtRequest request;
  const Envelope e = open_envelope(frame, true);
  request.fault = e.fault;
  request.station = e.station;
  request.command = e.command;
  request.kind = e.kind;
  const char command = upper(e.command);
  if (command == 'X' || command == 'Y') {
    request.service = command == 'X' ? XgtService::register_monitor : XgtService::run_monitor;
    const std::int64_t number = e.kind.size() < 2 ? -1 : hex_value(e.kind);
    if (number < 0 || number >= xgt_registrations) {
      const std::uint16_t code =
          command == 'X' ? xgt_error::register_number : xgt_error::execute_number;
      const std::string_view problem = number < 0 ? "is not two hex digits" : "is not 00 to 0F";
      request.fault.note(
          {XgtCheck::registration_number, code, "registration number", problem, 0, 4});
    } else {
      request.registration = static_cast<unsigned>(number);
    }
  } else {
    request.service = request.content = service_of(e.command, e.kind);
    if (request.service == XgtService::unknown) {
      const bool known = command == 'R' || command == 'W';
      const XgtFault wrong_command{XgtCheck::command, 0, "command", "is not R, W, X or Y", 0, 3};
      const XgtFault wrong_type{XgtCheck::command, 0, "command type", "is neither SS nor SB", 0, 4};
      request.fault.note(known ? wrong_type : wrong_command);
      return request;
    }
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
bool read_reply_block(Cursor& in, XgtReply& reply, unsigned number) {
  const std::size_t offset = in.offset();
  const std::string_view digits = in.take(2);
  const std::int64_t bytes = digits.size() < 2 ? -1 : hex_value(digits);
  if (bytes < 0) {
    reply.fault.note(
        {XgtCheck::count, 0, "number of data", "is not two hex digits", number, offset});
    return false;
  }
  const std::size_t data_offset = in.offset();
  const std::string_view data = in.take(static_cast<std::size_t>(bytes) * 2);
  if (data.size() < static_cast<std::size_t>(bytes) * 2) {
    reply.fault.note({XgtCheck::count, 0, "data", "is cut short", number, data_offset});
    return false;
  }
  if (!all_hex(data))
    reply.fault.note({XgtCheck::data, 0, "data", "is not hex", number, data_offset});
  reply.data[number - 1] = data;
  reply.blocks = number;
  return true;
}

void read_reply_blocks(Cursor in, XgtReply& reply) {
  reply.with_block_count = true;
  const std::size_t offset = in.offset();
  const std::string_view digits = in.take(2);
  const std::int64_t blocks = digits.size() < 2 ? -1 : hex_value(digits);
  if (blocks < 1 || blocks > xgt_max_blocks) {
    return reply.fault.note(
        {XgtCheck::block_count, 0, "block count", "is not 01 to 10", 0, offset});
  }
  for (unsigned i = 1; i <= static_cast<unsigned>(blocks); ++i) {
    if (!read_reply_block(in, reply, i)) return;
  }
  if (in.left() > 0)
    reply.fault.note({XgtCheck::surplus, 0, "surplus", "follows the last block", 0, in.offset()});
}

void read_ack(Cursor content, XgtReply& reply) {
  const char command = upper(reply.command);
  if (command == 'R') return read_reply_blocks(content, reply);
  if (command != 'Y') {
    if (content.left() > 0)
      reply.fault.note(
          {XgtCheck::surplus, 0, "surplus", "follows the last field", 0, content.offset()});
    return;
  }
  Cursor run = content;
  const std::string_view digits = run.take(2);
  const std::int64_t bytes = digits.size() < 2 ? -1 : hex_value(digits);
  if (bytes < 0 || run.left() != static_cast<std::size_t>(bytes) * 2)
    return read_reply_blocks(content, reply);
  read_reply_block(content, reply, 1);
}

void read_nak(Cursor content, XgtReply& reply) {
  const std::size_t offset = content.offset();
  const std::string_view digits = content.take(4);
  const std::int64_t code = digits.size() < 4 ? -1 : hex_value(digits);
  if (code < 0)
    return reply.fault.note({XgtCheck::data, 0, "error code", "is not four hex digits", 0, offset});
  reply.error = static_cast<std::uint16_t>(code);
  if (content.left() > 0)
    reply.fault.note(
        {XgtCheck::surplus, 0, "surplus", "follows the error code", 0, content.offset()});
}
}  // namespace

XgtReply parse_reply(ByteView frame) {
  XgtReply reply;
  const Envelope e = open_envelope(frame, false);
  reply.fault = e.fault;
  reply.ack = frame.empty() || frame[0] != xgt_nak;
  reply.station = e.station;
  reply.command = e.command;
  reply.kind = e.kind;
  const char command = upper(e.command);
  const bool numbered = command == 'X' || command == 'Y';
  const bool is_number = e.kind.size() == 2 && hex_value(e.kind) >= 0;
  if (numbered ? !is_number : service_of(e.command, e.kind) == XgtService::unknown) {
    reply.fault.note({XgtCheck::command, 0, "command", "is not RSS, RSB, WSS, WSB, X or Y", 0, 3});
    return reply;
  }
  if (reply.ack)
    read_ack(e.content, reply);
  else
    read_nak(e.content, reply);
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
