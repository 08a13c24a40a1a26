#include <fmt/format.h>
#include <algorithm>
#include <cctype>

#include "harness/notation/notation.hpp"
#include "src/base/letters.hpp"
#include "suites/checks/checks.hpp"
#include "suites/modbus/framing.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

using harness::Field;

namespace {

constexpr Byte start = ':', carriage_return = 0x0D, line_feed = 0x0A;

std::size_t find_from(ByteView bytes, Byte wanted, std::size_t from) {
  const auto rest = bytes.subspan(std::min(from, bytes.size()));
  return static_cast<std::size_t>(std::ranges::find(rest, wanted) - rest.begin()) + bytes.size() -
         rest.size();
}

/// Where the digits of a frame end: at CR, at LF or a new start where CR is missing, or with the
/// frame.
std::size_t end_of_digits(ByteView frame) {
  return std::min({find_from(frame, carriage_return, 1), find_from(frame, line_feed, 1),
                   find_from(frame, start, 1)});
}

/// The bytes that the hex pairs from `at` on stand for, up to the first that is none.
Bytes decoded(ByteView frame, std::size_t at, std::size_t end) {
  Bytes bytes;
  for (; at + 1 < end; at += 2) {
    const int high = hex_digit(static_cast<char>(frame[at])),
              low = hex_digit(static_cast<char>(frame[at + 1]));
    if (high < 0 || low < 0) break;
    bytes.push_back(static_cast<Byte>(high * 16 + low));
  }
  return bytes;
}

class Ascii : public Framing {
 public:
  std::string_view protocol_name() const override { return "modbus-ascii"; }
  Bytes station_bytes(int station) const override {
    return to_bytes(hex_number(static_cast<unsigned>(station), 2));
  }

  Spelling spelling() const override { return {.before = 1, .each = 2}; }

  Bytes wrap(ByteView message) const override {
    std::string text = ":";
    for (Byte b : message) text += hex_number(b, 2);
    Bytes frame = to_bytes(text);
    std::ranges::copy(checks::lrc.over(frame), std::back_inserter(frame));
    frame.insert(frame.end(), {carriage_return, line_feed});
    return frame;
  }

  Bytes unwrap(ByteView frame) const override {
    if (frame.empty() || frame[0] != start) return {};
    Bytes bytes = decoded(frame, 1, end_of_digits(frame));
    if (!bytes.empty()) bytes.pop_back();
    return bytes;
  }

  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    if (bytes.empty()) return std::nullopt;
    const std::size_t next = find_from(bytes, start, 1);
    const std::size_t line_end = find_from(bytes, line_feed, 0);
    if (line_end < next) return line_end + 1;
    return next < bytes.size() ? std::optional(next) : std::nullopt;
  }

  std::vector<Field> explain(ByteView frame, Way way) const override {
    if (frame.empty()) return {};
    if (frame[0] != start)
      return {{"foreign bytes", 0, frame.size(), notation::print_bytes(frame),
               "a frame begins with a colon"}};
    const std::size_t end = end_of_digits(frame);
    const Bytes bytes = decoded(frame, 1, end);
    const std::size_t decoded_end = 1 + bytes.size() * 2;
    const bool whole = decoded_end == end && !bytes.empty();
    std::vector<Field> fields{{"header", 0, 1, ":", ""}};
    for (Part& part : message_parts(ByteView(bytes).first(bytes.size() - (whole ? 1 : 0)), way)) {
      fields.push_back({std::move(part.name), 1 + part.at * 2, part.size * 2, std::move(part.text),
                        std::move(part.problem)});
      note_lower_case(frame, fields.back());
    }
    if (whole)
      fields.push_back(check_field(frame, end - checks::lrc.size));
    else
      add_rest(frame, decoded_end, end, fields);
    add_tail(frame, end, fields);
    return fields;
  }

  const notation::Dressing& dressing() const override {
    static constexpr notation::Dressing dressing{"[':' ${station} ${body} LRC${wrong} CR LF]",
                                                 true};
    return dressing;
  }
  Duration frame_gap(Duration) const override { return {}; }

  std::vector<Bytes> messages(ByteView bytes) const override {
    std::vector<Bytes> found;
    for (std::size_t at = find_from(bytes, start, 0); at < bytes.size();
         at = find_from(bytes, start, at + 1)) {
      const ByteView frame = bytes.subspan(at);
      const std::size_t end = end_of_digits(frame);
      Bytes message = decoded(frame, 1, end);
      const bool whole = message.size() * 2 + 1 == end && end < frame.size();
      if (whole && !message.empty()) message.pop_back();  // its LRC
      if (!message.empty()) found.push_back(std::move(message));
    }
    return found;
  }

 private:
  static void note_lower_case(ByteView frame, Field& field) {
    const std::string digits = to_text(frame.subspan(field.offset, field.size));
    if (digits == upper(digits)) return;
    field.text.replace(0, digits.size(), digits);
    if (field.problem.empty()) field.problem = "lower-case hex";
  }

  static Field check_field(ByteView frame, std::size_t at) {
    const std::string right = to_text(checks::lrc.over(frame.first(at)));
    const std::string text = to_text(frame.subspan(at, checks::lrc.size));
    Field field{"LRC", at, checks::lrc.size, text, ""};
    if (upper(text) == right) {
      note_lower_case(frame, field);
      return field;
    }
    unsigned sum = 0;
    for (Byte b : decoded(frame, 1, at)) sum += b;
    const bool uncomplemented = upper(text) == hex_number(sum & 0xFF, 2);
    field.problem = fmt::format("{} is right: the two's complement of the sum {:02X}{}", right,
                                sum & 0xFF, uncomplemented ? "; this one is the sum itself" : "");
    return field;
  }

  static void add_rest(ByteView frame, std::size_t at, std::size_t end,
                       std::vector<Field>& fields) {
    if (at >= end) return;
    const bool odd = end - at == 1 && hex_digit(static_cast<char>(frame[at])) >= 0;
    fields.push_back({odd ? "odd digit" : "not hex", at, end - at,
                      notation::print_bytes(frame.subspan(at, end - at)),
                      odd ? "an odd number of digits" : "not two hex digits a byte"});
  }

  static void add_tail(ByteView frame, std::size_t end, std::vector<Field>& fields) {
    if (end == frame.size()) {
      fields.back().problem +=
          fields.back().problem.empty() ? "no CR LF follows" : "; no CR LF follows";
      return;
    }
    const ByteView tail = frame.subspan(end);
    const bool right = tail.size() == 2 && tail[0] == carriage_return && tail[1] == line_feed;
    fields.push_back({"tail", end, tail.size(), notation::print_bytes(tail),
                      right ? "" : "a frame ends with CR LF"});
  }
};

}  // namespace

const Framing& ascii_framing() {
  static const Ascii ascii;
  return ascii;
}

}  // namespace fieldproof::modbus_suite
