#include "src/xgt_fenet/header.hpp"

#include <algorithm>
#include <numeric>

namespace fieldproof::xgt_fenet {

std::optional<Header> read_header(ByteView bytes) {
  if (bytes.size() < header_size) return std::nullopt;
  Header header;
  std::ranges::copy(bytes.first(header.company.size()), header.company.begin());
  header.plc_info = word_at(bytes, 10);
  header.cpu_info = bytes[12];
  header.source = bytes[13];
  header.invoke = word_at(bytes, 14);
  header.length = word_at(bytes, 16);
  header.position = bytes[18];
  header.check = bytes[19];
  return header;
}

Byte header_check(ByteView frame) {
  const ByteView covered = frame.first(header_size - 1);
  return static_cast<Byte>(std::accumulate(covered.begin(), covered.end(), 0u));
}

Bytes encode_frame(const Header& header, ByteView body) {
  Bytes frame(header_size + body.size());
  const auto set_word = [&frame](std::size_t at, std::size_t value) {
    frame[at] = static_cast<Byte>(value);
    frame[at + 1] = static_cast<Byte>(value >> 8);
  };
  std::ranges::copy(header.company, frame.begin());
  set_word(10, header.plc_info);
  frame[12] = header.cpu_info;
  frame[13] = header.source;
  set_word(14, header.invoke);
  set_word(16, body.size());
  frame[18] = header.position;
  frame[19] = header_check(frame);
  std::ranges::copy(body, frame.begin() + header_size);
  return frame;
}

}  // namespace fieldproof::xgt_fenet
