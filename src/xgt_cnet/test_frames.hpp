// For tests: frames as text, with a BCC of the tests' own.
#pragma once

#include <string>
#include <string_view>

#include "src/base/bytes.hpp"
#include "src/line/device.hpp"

namespace fieldproof::xgt_cnet::test {

constexpr Duration character = 1ms, gap = 4ms;

/// Header, body, tail and, where the command letter of the body is lower case, BCC.
inline Bytes framed(char head, std::string_view body, char tail) {
  std::string text = head + std::string(body) + tail;
  if (body.size() > 2 && body[2] >= 'a' && body[2] <= 'z') {
    unsigned sum = 0;
    for (const char c : text) sum += static_cast<unsigned char>(c);
    text += hex_number(sum & 0xFF, 2);
  }
  return to_bytes(text);
}

inline Bytes enq(std::string_view body) { return framed('\x05', body, '\x04'); }
inline Bytes ack(std::string_view body) { return framed('\x06', body, '\x03'); }
inline Bytes nak(std::string_view body) { return framed('\x15', body, '\x03'); }

/// A reply as text: "ACK 01rSS01021234", "NAK 01rSS1132", "" for silence; its BCC is checked and
/// left out.
inline std::string shown(ByteView reply) {
  if (reply.empty()) return "";
  const std::string text = to_text(reply);
  const std::size_t tail = text.find('\x03');
  if (tail == std::string::npos || tail == 0) return "no frame: " + to_hex(reply);
  const std::string body = text.substr(1, tail - 1);
  const std::string head = text[0] == '\x06' ? "ACK" : text[0] == '\x15' ? "NAK" : "?";
  if (framed(text[0], body, '\x03') != Bytes(reply.begin(), reply.end()))
    return "wrong check: " + to_hex(reply);
  return head + ' ' + body;
}

inline Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace fieldproof::xgt_cnet::test
