#include "src/xgt_fenet/client_body.hpp"

#include "src/xgt_fenet/header.hpp"

namespace fieldproof::xgt_fenet {

namespace {

constexpr std::size_t command_at = 0, status_at = 6, blocks_at = 8, head_size = 10;

/// Takes the data of the next block off `rest`.
std::optional<ByteView> take_data(ByteView& rest) {
  if (rest.size() < 2) return std::nullopt;
  const std::size_t size = word_at(rest, 0);
  if (rest.size() < 2 + size) return std::nullopt;
  const ByteView data = rest.subspan(2, size);
  rest = rest.subspan(2 + size);
  return data;
}

}  // namespace

Bytes encode_request(const Request& request) {
  Bytes body;
  put_word(body, request.command);
  put_word(body, request.type);
  put_word(body, 0);
  put_word(body, request.blocks.size());
  for (const Request::Block& block : request.blocks) {
    put_word(body, block.name.size());
    body.insert(body.end(), block.name.begin(), block.name.end());
  }
  for (const Request::Block& block : request.blocks) {
    if (request.writes() || request.is_continuous()) put_word(body, block.size);
    body.insert(body.end(), block.data.begin(), block.data.end());  // none of a read
  }
  return body;
}

std::optional<Reply> parse_reply(ByteView body) {
  if (body.size() < head_size) return std::nullopt;
  Reply reply{.command = word_at(body, command_at)};
  ByteView rest = body.subspan(head_size);
  if (word_at(body, status_at) != error::none) {
    reply.refused = word_at(body, blocks_at);
    return rest.empty() ? std::optional(reply) : std::nullopt;
  }
  reply.blocks = word_at(body, blocks_at);
  if (reply.command != write_command + 1u) {
    for (unsigned i = 0; i < reply.blocks; ++i) {
      const std::optional<ByteView> data = take_data(rest);
      if (!data) return std::nullopt;
      reply.data.push_back(*data);
    }
  }
  return rest.empty() ? std::optional(reply) : std::nullopt;
}

}  // namespace fieldproof::xgt_fenet
