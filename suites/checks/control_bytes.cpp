#include "suites/checks/control_bytes.hpp"

namespace fieldproof::checks {

bool is_header(Byte b) { return b == enq || b == ack || b == nak; }

std::string_view header_name(Byte b) {
  switch (b) {
    case enq: return "ENQ (request)";
    case ack: return "ACK";
    case nak: return "NAK";
    default: return "not ENQ, ACK or NAK";
  }
}

std::string printable(ByteView bytes) {
  std::string text;
  for (const Byte b : bytes)
    text +=
        b >= 0x20 && b < 0x7F ? std::string(1, static_cast<char>(b)) : '<' + hex_number(b, 2) + '>';
  return text;
}

}  // namespace fieldproof::checks
