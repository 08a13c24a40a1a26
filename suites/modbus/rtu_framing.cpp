#include <fmt/format.h>
#include <algorithm>

#include "suites/checks/checks.hpp"
#include "suites/modbus/framing.hpp"
#include "suites/modbus/message.hpp"

namespace fieldproof::modbus_suite {

namespace {

constexpr std::size_t shortest_frame = 4;  // station, function code, CRC
constexpr std::size_t longest_frame = 256;

bool right_check(ByteView frame) {
  const Bytes crc = checks::crc.over(frame.first(frame.size() - checks::crc.size));
  return std::ranges::equal(crc, frame.last(checks::crc.size));
}

/// The length of a frame with a right CRC at the front of `bytes`.
std::optional<std::size_t> right_length(ByteView bytes) {
  if (bytes.size() < shortest_frame) return std::nullopt;
  for (const std::size_t length : message_lengths(bytes))
    if (const std::size_t size = length + checks::crc.size;
        size <= bytes.size() && right_check(bytes.first(size)))
      return size;
  return std::nullopt;
}

/// The same for a function code that tells no length.
std::optional<std::size_t> right_length_of_any(ByteView bytes) {
  if (!message_lengths(bytes).empty()) return right_length(bytes);
  for (std::size_t size = shortest_frame; size <= std::min(bytes.size(), longest_frame); ++size)
    if (right_check(bytes.first(size))) return size;
  return std::nullopt;
}

class Rtu : public Framing {
 public:
  std::string_view protocol_name() const override { return "modbus-rtu"; }
  Bytes station_bytes(int station) const override { return {static_cast<Byte>(station)}; }

  Bytes wrap(ByteView message) const override {
    Bytes frame(message.begin(), message.end());
    std::ranges::copy(checks::crc.over(message), std::back_inserter(frame));
    return frame;
  }

  Bytes unwrap(ByteView frame) const override {
    const ByteView message = frame.first(message_size(frame));
    return {message.begin(), message.end()};
  }

  std::optional<std::size_t> frame_length(ByteView bytes) const override {
    if (const auto right = right_length_of_any(bytes)) return right;
    for (std::size_t at = 1; at + shortest_frame <= std::min(bytes.size(), longest_frame); ++at)
      if (right_length(bytes.subspan(at))) return at;  // a frame after foreign bytes
    const std::vector<std::size_t> lengths =
        message_lengths(bytes);  // a wrong CRC ends a reply as well
    if (lengths.empty() || lengths.front() + checks::crc.size > bytes.size()) return std::nullopt;
    return lengths.front() + checks::crc.size;
  }

  std::vector<harness::Field> explain(ByteView frame, Way way) const override {
    std::vector<harness::Field> fields;
    const std::size_t size = message_size(frame);
    for (Part& part : message_parts(frame.first(size), way))
      fields.push_back({std::move(part.name), part.at, part.size, std::move(part.text),
                        std::move(part.problem)});
    const ByteView rest = frame.subspan(size);
    if (rest.empty() && !fields.empty() && fields.back().problem.empty())
      fields.back().problem = "no CRC follows";
    if (rest.empty() && way == Way::unknown) say_how_many_are_missing(frame, fields);
    if (rest.empty()) return fields;
    const ByteView crc = rest.first(std::min(checks::crc.size, rest.size()));
    fields.push_back({"CRC", size, crc.size(),
                      hex_number(crc[0], 2) + (crc.size() > 1 ? hex_number(crc[1], 2) : ""),
                      check_problem(frame.first(size), crc)});
    if (way == Way::unknown) say_how_many_are_missing(frame, fields);
    if (rest.size() > checks::crc.size)
      fields.push_back({"surplus", size + checks::crc.size, rest.size() - checks::crc.size,
                        to_hex(rest.subspan(checks::crc.size)), "follows a complete frame"});
    return fields;
  }

  const notation::Dressing& dressing() const override {
    static constexpr notation::Dressing dressing{"[${station} ${body} CRC${wrong}]", false};
    return dressing;
  }

  /// 3.5 characters of 11 bits (Cnet KO 4.3.1), in characters of 10 bits or more.
  Duration frame_gap(Duration character_time) const override { return character_time * 4; }

  std::vector<Bytes> messages(ByteView bytes) const override {
    std::vector<Bytes> found;
    bool begins = true;
    for (std::size_t at = 0; at < bytes.size();) {
      const ByteView rest = bytes.subspan(at);
      const auto right = right_length(rest);
      if (right)
        found.emplace_back(rest.begin(),
                           rest.begin() + static_cast<std::ptrdiff_t>(*right - checks::crc.size));
      else if (begins)
        found.emplace_back(rest.begin(), rest.end());  // damaged, or of an unknown function
      begins = right.has_value();
      at += right.value_or(1);
    }
    return found;
  }

 private:
  /// The function code tells how long the frame becomes.
  static void say_how_many_are_missing(ByteView frame, std::vector<harness::Field>& fields) {
    const std::vector<std::size_t> lengths = message_lengths(frame);
    const std::size_t due = lengths.empty() ? 0 : lengths.front() + checks::crc.size;
    if (fields.empty() || due <= frame.size() || right_length_of_any(frame)) return;
    std::string& problem = fields.back().problem;
    problem += fmt::format("{}{} of {} bytes are missing", problem.empty() ? "" : "; ",
                           due - frame.size(), due);
  }

  /// What stands before the CRC: where a CRC is right, else all but two bytes.
  static std::size_t message_size(ByteView frame) {
    if (frame.size() < shortest_frame) return frame.size();
    // The length first: the CRC over a frame with a right CRC and a zero byte is right as well.
    if (const auto right = right_length(frame)) return *right - checks::crc.size;
    if (right_check(frame)) return frame.size() - checks::crc.size;
    const std::vector<std::size_t> lengths = message_lengths(frame);
    const bool without_check = !lengths.empty() && lengths.front() == frame.size();
    return without_check ? frame.size() : frame.size() - checks::crc.size;
  }

  static std::string check_problem(ByteView message, ByteView crc) {
    if (crc.size() < checks::crc.size) return "cut short";
    const Bytes right = checks::crc.over(message);
    if (std::ranges::equal(right, crc)) return {};
    const bool swapped = right[0] == crc[1] && right[1] == crc[0];
    return fmt::format("{:02X}{:02X} is right: the CRC-16 of the bytes before it, low byte first{}",
                       right[0], right[1], swapped ? "; this one has its high byte first" : "");
  }
};

}  // namespace

const Framing& rtu_framing() {
  static const Rtu rtu;
  return rtu;
}

}  // namespace fieldproof::modbus_suite
