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
  Bytes frame;
  frame.reserve(header_size + body.size());
  frame.insert(frame.end(), header.company.begin(), header.company.end());
  put_word(frame, header.plc_info);
  frame.push_back(header.cpu_info);
  frame.push_back(header.source);
  put_word(frame, header.invoke);
  put_word(frame, body.size());
  frame.push_back(header.position);
  frame.push_back(header_check(frame));
  frame.insert(frame.end(), body.begin(), body.end());
  return frame;
}

}  // namespace fieldproof::xgt_fenet
