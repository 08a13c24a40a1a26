#include "src/ls_bus/codec.hpp"

#include <numeric>

namespace fieldproof::ls_bus {

namespace {
constexpr std::size_t shortest_frame = 1 + 2 + 1 + 2 + 1;  // header, station, command, sum, EOT

std::optional<unsigned> hex_value(ByteView digits) {
  if (digits.empty()) return std::nullopt;
  unsigned value = 0;
  for (const Byte b : digits) {
    const int digit = hex_digit(static_cast<char>(b));
    if (digit < 0) return std::nullopt;
    value = value << 4 | static_cast<unsigned>(digit);
  }
  return value;
}

/// Takes fields off the front; nothing where one is cut short or not hex.
class Fields {
 public:
  explicit Fields(ByteView rest) : rest_(rest) {}

  std::optional<unsigned> hex(std::size_t digits) {
    if (rest_.size() < digits) return std::nullopt;
    const ByteView field = rest_.first(digits);
    rest_ = rest_.subspan(digits);
    return hex_value(field);
  }
  bool empty() const { return rest_.empty(); }

 private:
  ByteView rest_;
};

/// What stands between command and sum.
LsFault parse_content(ByteView content, LsWriteOrder order, LsRequest& request) {
  Fields fields(content);
  const bool write = request.command == 'W';
  const bool count_first = write && order == LsWriteOrder::count_first;
  const std::optional<unsigned> first = fields.hex(count_first ? 1 : 4);
  const std::optional<unsigned> second = fields.hex(count_first ? 4 : 1);
  const std::optional<unsigned>& address = count_first ? second : first;
  if (!address) return LsFault::address;
  request.address = *address;
  request.count = (count_first ? first : second).value_or(0);
  if (request.count == 0 || request.count > ls_max_words) return LsFault::data;
  for (unsigned i = 0; write && i < request.count; ++i) {
    const std::optional<unsigned> word = fields.hex(4);
    if (!word) return LsFault::data;
    request.data[i] = static_cast<std::uint16_t>(*word);
  }
  return fields.empty() ? LsFault::none : LsFault::data;
}

void append(Bytes& out, std::string_view text) { out.insert(out.end(), text.begin(), text.end()); }

Bytes begin_frame(Byte header, unsigned station, char command) {
  Bytes frame{header};
  append(frame, hex_number(station, 2));
  frame.push_back(static_cast<Byte>(command));
  return frame;
}

void end_frame(Bytes& frame) {
  append(frame, hex_number(ls_sum(ByteView(frame).subspan(1)), 2));
  frame.push_back(ls_eot);
}

void append_words(Bytes& frame, std::span<const std::uint16_t> words) {
  for (const std::uint16_t word : words) append(frame, hex_number(word, 4));
}
}  // namespace

std::string_view ls_error_code(LsFault fault) {
  switch (fault) {
    case LsFault::none: return "";
    case LsFault::frame: return "FE";
    case LsFault::function: return "IF";
    case LsFault::address:
    case LsFault::range: return "IA";
    case LsFault::data: return "ID";
    case LsFault::rights: return "WM";
  }
  return "";
}

LsRequest parse_ls_request(ByteView frame, LsWriteOrder order) {
  LsRequest request;
  if (frame.size() < shortest_frame) return request;
  const ByteView summed = frame.subspan(1, frame.size() - 4);
  request.station = hex_value(summed.first(2));
  request.command = static_cast<char>(summed[2]);
  if (hex_value(frame.subspan(frame.size() - 3, 2)) != ls_sum(summed))
    request.fault = LsFault::frame;
  else if (request.command != 'R' && request.command != 'W')
    request.fault = LsFault::function;
  else
    request.fault = parse_content(summed.subspan(3), order, request);
  return request;
}

Bytes encode_ls_request(const LsRequest& request, LsWriteOrder order) {
  Bytes frame = begin_frame(ls_enq, request.station.value_or(0), request.command);
  const std::string address = hex_number(request.address, 4), count = hex_number(request.count, 1);
  const bool write = request.command == 'W';
  const bool count_first = write && order == LsWriteOrder::count_first;
  append(frame, count_first ? count + address : address + count);
  if (write)
    append_words(frame, std::span(request.data).first(std::min(request.count, ls_max_words)));
  end_frame(frame);
  return frame;
}

Bytes encode_ls_ack(unsigned station, char command, std::span<const std::uint16_t> data) {
  Bytes frame = begin_frame(ls_ack, station, command);
  append_words(frame, data);
  end_frame(frame);
  return frame;
}

Bytes encode_ls_nak(unsigned station, char command, std::string_view code) {
  Bytes frame = begin_frame(ls_nak, station, command);
  append(frame, code);
  end_frame(frame);
  return frame;
}

LsReply parse_ls_reply(ByteView frame) {
  LsReply reply;
  if (frame.size() < shortest_frame) return reply;
  const ByteView summed = frame.subspan(1, frame.size() - 4);
  reply.whole = true;
  reply.sum_right = hex_value(frame.subspan(frame.size() - 3, 2)) == ls_sum(summed);
  reply.ack = frame[0] == ls_ack;
  reply.station = hex_value(summed.first(2));
  reply.command = static_cast<char>(summed[2]);
  reply.content = summed.subspan(3);
  return reply;
}

std::optional<std::vector<std::uint16_t>> ls_words(ByteView content) {
  std::vector<std::uint16_t> words;
  for (Fields fields(content); !fields.empty();) {
    const std::optional<unsigned> word = fields.hex(digits_of_a_word);
    if (!word) return std::nullopt;
    words.push_back(static_cast<std::uint16_t>(*word));
  }
  return words;
}

std::optional<unsigned> parse_ls_address(std::string_view text) {
  if (text.starts_with('h') || text.starts_with('H')) text.remove_prefix(1);
  if (text.size() != digits_of_a_word) return std::nullopt;
  return hex_value(to_bytes(text));
}

Byte ls_sum(ByteView between_header_and_sum) {
  return static_cast<Byte>(
      std::accumulate(between_header_and_sum.begin(), between_header_and_sum.end(), 0u));
}

bool LsReceiver::take(Byte b) {
  if (begins(b)) {
    frame_.assign(1, b);
    inside_ = true;
    return false;
  }
  if (!inside_) return false;
  inside_ = frame_.size() < buffer_size && b != ls_eot;
  if (frame_.size() == buffer_size) return false;
  frame_.push_back(b);
  return b == ls_eot;
}

}  // namespace fieldproof::ls_bus
