#include <fmt/format.h>

#include <algorithm>

#include "suites/modbus/framing.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

namespace {

using harness::Field;

// Transaction, protocol and length stand before unit and function (FEnet EN 5.3.3).
constexpr std::size_t protocol_at = 2, length_at = 4, prefix = 6;
/// Of what the bench asks for itself: counted by no case, and another one for another request.
unsigned own_transaction(ByteView message) {
  unsigned sum = 0;
  for (const Byte byte : message) sum = sum * 31 + byte;
  return 0x4000 | (sum & 0x3FFF);
}

/// So many bytes that the header announces, as far as they are there.
ByteView announced(ByteView frame) {
  return frame.subspan(prefix,
                       std::min<std::size_t>(word_at(frame, length_at), frame.size() - prefix));
}

class Tcp : public Framing {
 public:
  std::string_view protocol_name() const override { return "modbus-tcp"; }
  Bytes station_bytes(int station) const override { return {static_cast<Byte>(station)}; }
  Spelling spelling() const override { return {.before = prefix, .each = 1}; }

  Bytes wrap(ByteView message) const override {
    Bytes frame;
    put_word(frame, own_transaction(message));
    put_word(frame, 0);
    put_word(frame, message.size());
    frame.insert(frame.end(), message.begin(), message.end());
    return frame;
  }

  Bytes unwrap(ByteView frame) const override {
    if (frame.size() <= prefix) return {};
    const ByteView message = announced(frame);
    return {message.begin(), message.end()};
  }

  /// The length alone says where a frame ends.
  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    if (bytes.size() < prefix) return std::nullopt;
    const std::size_t size = prefix + word_at(bytes, length_at);
    return size <= bytes.size() ? std::optional(size) : std::nullopt;
  }

  std::vector<Field> explain(ByteView frame, Way way) const override {
    std::vector<Field> fields;
    for (const char* name : {"transaction", "protocol", "length"}) {
      const std::size_t at = fields.size() * 2;
      if (at >= frame.size()) return cut_short(std::move(fields));
      const ByteView bytes = frame.subspan(at, std::min<std::size_t>(2, frame.size() - at));
      fields.push_back(
          {name, at, bytes.size(), digits(bytes), bytes.size() < 2 ? "cut short" : ""});
    }
    if (frame.size() < prefix) return fields;
    if (word_at(frame, protocol_at) != 0) fields[1].problem = "0000 is Modbus";
    const std::size_t rest = frame.size() - prefix, due = word_at(frame, length_at);
    if (due < 2 || due > rest)
      fields[2].problem =
          fmt::format("{:04X} is right: unit and what follows it, {} bytes", rest, rest);
    const std::size_t size = due < 2 ? rest : std::min(due, rest);
    for (Part& part : message_parts(frame.subspan(prefix, size), way))
      fields.push_back({part.at == 0 ? "unit" : std::move(part.name), prefix + part.at, part.size,
                        std::move(part.text), std::move(part.problem)});
    if (size < rest)
      fields.push_back({"surplus", prefix + size, rest - size, digits(frame.subspan(prefix + size)),
                        "follows a complete frame"});
    return fields;
  }

  const notation::Dressing& dressing() const override {
    static constexpr notation::Dressing dressing{
        "[${transaction} 00 00 LEN${wrong} ${station} ${body}]", false};
    return dressing;
  }
  bool has_check() const override { return false; }
  bool pairs(ByteView request, ByteView reply) const override {
    return request.size() > prefix && reply.size() > prefix &&
           word_at(request, 0) == word_at(reply, 0);
  }
  Duration frame_gap(Duration) const override { return {}; }

  /// A device may follow the length, or go by what came.
  std::vector<Bytes> messages(ByteView bytes) const override {
    std::vector<Bytes> found;
    while (bytes.size() > prefix) {
      const ByteView rest = bytes.subspan(prefix), message = announced(bytes);
      if (message.size() > 1) found.emplace_back(message.begin(), message.end());
      const bool trusted = message.size() > 1 && word_at(bytes, length_at) <= rest.size();
      if (!trusted || message.size() < rest.size()) found.emplace_back(rest.begin(), rest.end());
      if (message.empty()) break;
      bytes = rest.subspan(message.size());
    }
    return found;
  }

 private:
  static std::vector<Field> cut_short(std::vector<Field> fields) {
    if (!fields.empty() && fields.back().problem.empty())
      fields.back().problem = "the frame ends here";
    return fields;
  }
};

}  // namespace

const Framing& tcp_framing() {
  static const Tcp tcp;
  return tcp;
}

}  // namespace fieldproof::modbus_suite
