#include "suites/xgt_cnet/broken/good_plc.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "src/base/letters.hpp"

namespace fieldproof::xgt_cnet_broken {

std::string FrameText::service() const {
  return upper(body.substr(std::min<std::size_t>(2, body.size()), 3));
}

std::string sum_of(std::string_view text) {
  unsigned sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  return hex_number(sum & 0xFF, 2);
}

void FrameText::seal() {
  if (!check.empty()) check = sum_of(without_check());
}

FrameText take_apart(ByteView frame) {
  const std::string text = to_text(frame);
  FrameText parts;
  const std::size_t tail = text.find_first_of("\x03\x04");
  if (tail == std::string::npos || tail == 0) return parts;
  parts.head = text[0];
  parts.body = text.substr(1, tail - 1);
  parts.tail = text[tail];
  parts.check = text.substr(tail + 1);
  return parts;
}

Bytes ack_to(const xgt_cnet::XgtRequest& request, std::string_view content) {
  Bytes bytes;
  xgt_cnet::encode_reply(
      {.station = request.station, .command = request.command, .kind = request.kind}, bytes);
  FrameText ack = take_apart(bytes);
  ack.body += content;
  ack.seal();
  return ack.bytes();
}

Bytes nak_to(const xgt_cnet::XgtRequest& request, std::uint16_t code) {
  Bytes bytes;
  xgt_cnet::encode_reply({.ack = false,
                          .station = request.station,
                          .command = request.command,
                          .kind = request.kind,
                          .error = code},
                         bytes);
  return bytes;
}

std::optional<unsigned> refusal(ByteView reply) {
  if (reply.empty() || reply[0] != xgt_cnet::xgt_nak) return std::nullopt;
  return xgt_cnet::parse_reply(reply).error;
}

NameParts split_name(std::string_view name) {
  NameParts parts{std::string(name.substr(0, 3)), std::nullopt};
  const std::string_view digits = name.substr(std::min<std::size_t>(3, name.size()));
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error == std::errc{} && end == digits.data() + digits.size()) parts.number = number;
  return parts;
}

}  // namespace fieldproof::xgt_cnet_broken
