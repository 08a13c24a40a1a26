#include "src/xgt_fenet/request.hpp"

#include "src/xgt_fenet/header.hpp"

namespace fieldproof::xgt_fenet {

namespace {

constexpr std::uint16_t most_types = 5, refused = 0xFFFF;
constexpr std::size_t data_type_at = 2, count_at = 6, request_head = 8,  // behind a reserved word
    status_head = 10;  // of a reply, with its status and count or code

/// What is left of a body.
class Reader {
 public:
  explicit Reader(ByteView body) : rest_(body) {}

  bool word(std::uint16_t& to) {
    if (rest_.size() < 2) return false;
    to = word_at(rest_, 0);
    rest_ = rest_.subspan(2);
    return true;
  }
  bool take(std::size_t size, ByteView& to) {
    if (rest_.size() < size) return false;
    to = rest_.first(size);
    rest_ = rest_.subspan(size);
    return true;
  }
  bool is_empty() const { return rest_.empty(); }

 private:
  ByteView rest_;
};

std::uint16_t read_name(Reader& reader, std::string_view& to) {
  std::uint16_t length = 0;
  if (!reader.word(length)) return error::length;
  if (length < shortest_name || length > longest_name) return error::name;
  ByteView text;
  if (!reader.take(length, text)) return error::length;
  to = {reinterpret_cast<const char*>(text.data()), text.size()};
  return error::none;
}

std::uint16_t read_blocks(Reader& reader, Request& request) {
  for (Request::Block& block : request.blocks)
    if (const std::uint16_t fault = read_name(reader, block.name)) return fault;
  for (Request::Block& block : request.blocks) {
    if (!request.writes() && !request.is_continuous()) break;
    if (!reader.word(block.size)) return error::length;
    if (request.writes() && !reader.take(block.size, block.data)) return error::length;
  }
  return reader.is_empty() ? error::none : error::length;
}

/// Of a body that may be cut there: what is missing counts as 0.
std::uint16_t word_or_zero(ByteView body, std::size_t at) {
  const auto byte = [&](std::size_t i) { return i < body.size() ? body[i] : Byte{0}; };
  return static_cast<std::uint16_t>(byte(at) | byte(at + 1) << 8);
}

std::uint16_t read_body(ByteView body, Request& request) {
  if (body.size() < data_type_at) return error::length;
  if (request.command != read_command && request.command != write_command) return error::command;
  if (request.type >= most_types && !request.is_continuous()) return error::data_type;
  if (body.size() < request_head) return error::length;
  const unsigned count = word_at(body, count_at);
  if (count == 0 || count > (request.is_continuous() ? 1 : most_blocks)) return error::blocks;
  request.blocks.resize(count);
  Reader reader(body.subspan(request_head));
  return read_blocks(reader, request);
}

/// Up to the status, with room for that and `more` bytes. The number of a reply is that of its
/// request plus one.
Bytes reply_head(const Request& request, std::size_t more = 0) {
  Bytes body;
  body.reserve(status_head + more);
  put_word(body, request.command + 1u);
  put_word(body, request.type);
  put_word(body, 0);
  return body;
}

}  // namespace

Request parse_request(ByteView body) {
  Request request{.command = word_or_zero(body, 0), .type = word_or_zero(body, data_type_at)};
  request.fault = read_body(body, request);
  return request;
}

Bytes encode_reply(const Request& request, std::span<const Bytes> data) {
  std::size_t room = 0;
  for (const Bytes& one : data) room += sizeof(std::uint16_t) + one.size();
  Bytes body = reply_head(request, room);
  put_word(body, error::none);
  put_word(body, request.blocks.size());
  for (const Bytes& one : data) {
    put_word(body, one.size());
    body.insert(body.end(), one.begin(), one.end());
  }
  return body;
}

Bytes encode_refusal(const Request& request, std::uint16_t code) {
  Bytes body = reply_head(request);
  put_word(body, refused);
  put_word(body, code);
  return body;
}

}  // namespace fieldproof::xgt_fenet
