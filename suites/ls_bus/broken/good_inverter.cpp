#include "suites/ls_bus/broken/good_inverter.hpp"

#include <algorithm>
#include <cctype>

namespace fieldproof::ls_bus_broken {

std::string in_lower_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string sum_of(std::string_view text) {
  unsigned sum = 0;
  for (const char c : text) sum += static_cast<unsigned char>(c);
  return hex_number(sum & 0xFF, 2);
}

void FrameText::seal() { sum = sum_of(body); }

bool FrameText::is_sealed() const { return sum == sum_of(body); }

FrameText take_apart(ByteView frame) {
  constexpr std::size_t head_and_tail = 2, sum_size = 2;
  FrameText parts;
  if (frame.size() < head_and_tail || frame.back() != ls_bus::ls_eot) return parts;
  const std::string text = to_text(frame.subspan(1, frame.size() - head_and_tail));
  const std::size_t body = text.size() < sum_size ? text.size() : text.size() - sum_size;
  parts.head = static_cast<char>(frame[0]);
  parts.body = text.substr(0, body);
  parts.sum = text.substr(body);
  return parts;
}

namespace {
FrameText reply_to(const FrameText& request, Byte head, std::string_view content) {
  FrameText reply{static_cast<char>(head), request.body, {}};
  reply.set_content(content);
  reply.seal();
  return reply;
}
}  // namespace

FrameText ack_to(const FrameText& request, std::string_view content) {
  return reply_to(request, ls_bus::ls_ack, content);
}
FrameText nak_to(const FrameText& request, std::string_view code) {
  return reply_to(request, ls_bus::ls_nak, code);
}

}  // namespace fieldproof::ls_bus_broken
