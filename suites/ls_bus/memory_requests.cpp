#include "suites/ls_bus/memory_requests.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "harness/notation/beginning.hpp"
#include "src/ls_bus/parameters.hpp"
#include "suites/ls_bus/frame_parts.hpp"

namespace fieldproof::ls_bus_suite {

using harness::Protocol;

namespace {

/// What inverters of LS tell of themselves and of their state (DECISIONS.md 'LS Bus').
struct Range {
  std::uint32_t first = 0, last = 0;
};
constexpr std::array read_only{Range{0x0000, 0x0003}, Range{0x0009, 0x000F}};

std::optional<std::uint32_t> value_of(std::string_view digits) {
  if (digits.size() != digits_of_a_word) return std::nullopt;
  std::uint32_t value = 0;
  for (const char c : digits) {
    if (hex_digit(c) < 0) return std::nullopt;
    value = value << 4 | static_cast<std::uint32_t>(hex_digit(c));
  }
  return value;
}

struct Part {
  std::string address;
  std::size_t first = 0, words = 0;  // of the whole
};

/// Cuts `digits` of memory from `address` on into requests of at most eight words.
Result<std::vector<Part>> parts_of(std::string_view address, std::size_t digits) {
  if (address.starts_with('@'))
    return fail(fmt::format("{} is a counter, which no inverter has", address));
  const bool prefixed = address.starts_with('h') || address.starts_with('H');
  const std::optional<std::uint32_t> first = value_of(prefixed ? address.substr(1) : address);
  if (!first)
    return fail(
        fmt::format("'{}' is no parameter address: write four hex digits such as 1230", address));
  if (digits == 0 || digits % digits_of_a_word != 0)
    return fail(fmt::format("{} digits at {} are not a whole number of words (4 digits each)",
                            digits, address));
  const std::size_t words = digits / digits_of_a_word;
  if (*first + words > 0x10000)
    return fail(fmt::format("{} words at {} go beyond FFFF", words, address));
  std::vector<Part> parts;
  for (std::size_t done = 0; done < words; done += max_words)
    parts.push_back(
        {hex_number(*first + done, digits_of_a_word), done, std::min(max_words, words - done)});
  return parts;
}

std::optional<std::string> refusal(ByteView reply) {
  if (reply.empty()) return "no answer";
  if (reply[0] == nak) {
    for (const harness::Field& field : explain(reply))
      if (field.name == "error code") return "the device answers NAK " + field.text;
    return "the device answers NAK";
  }
  if (reply[0] != ack)
    return "the answer is neither ACK nor NAK: " + notation::print_beginning(reply);
  return std::nullopt;
}

}  // namespace

Bytes request(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum += static_cast<unsigned char>(c);
  return to_bytes(fmt::format("\x05{}{}\x04", body, hex_number(sum & 0xFF, 2)));
}

Result<std::vector<Bytes>> write_requests(std::string_view station, std::string_view address,
                                          std::string_view hex, bool count_first) {
  const Result<std::vector<Part>> parts = parts_of(address, hex.size());
  if (!parts) return parts.error();
  const std::uint32_t first = *value_of(parts->front().address);
  const auto last = static_cast<std::uint32_t>(first + hex.size() / digits_of_a_word - 1);
  for (const Range& range : read_only)
    if (first <= range.last && range.first <= last)
      return fail(
          fmt::format("the parameters {:04X} to {:04X} are read only", range.first, range.last));
  std::vector<Bytes> requests;
  for (const Part& part : *parts) {
    const std::string_view data =
        hex.substr(part.first * digits_of_a_word, part.words * digits_of_a_word);
    const std::string count = std::to_string(part.words);
    requests.push_back(request(fmt::format("{}W{}{}{}", station, count_first ? count : part.address,
                                           count_first ? part.address : count, data)));
  }
  return requests;
}

Result<std::vector<Bytes>> read_requests(std::string_view station, std::string_view address,
                                         std::size_t digits) {
  const Result<std::vector<Part>> parts = parts_of(address, digits);
  if (!parts) return parts.error();
  std::vector<Bytes> requests;
  for (const Part& part : *parts)
    requests.push_back(request(fmt::format("{}R{}{}", station, part.address, part.words)));
  return requests;
}

Status write_reply(ByteView reply) {
  if (const std::optional<std::string> why = refusal(reply)) return fail(*why);
  return ok();
}

Result<std::string> read_reply(ByteView reply) {
  if (const std::optional<std::string> why = refusal(reply)) return fail(*why);
  std::string digits;
  for (const harness::Field& field : explain(reply))
    if (field.name.starts_with("data")) digits += field.text;
  if (digits.empty()) return fail("the answer holds no data");
  return digits;
}

bool answers(ByteView request, ByteView reply) {
  constexpr std::size_t body_at = 4;  // header, station and command stand before it
  if (request.size() < body_at || reply.size() < body_at) return false;
  if (!std::ranges::equal(request.subspan(1, body_at - 1), reply.subspan(1, body_at - 1)))
    return false;
  if (reply[0] == nak || request[body_at - 1] != 'R') return true;
  const std::size_t asked = body_at + digits_of_a_word;  // where its number of words stands
  std::size_t digits = 0;
  for (const harness::Field& field : explain(reply))
    if (field.name.starts_with("data")) digits += field.size;
  return request.size() > asked &&
         digits == digits_of_a_word *
                       static_cast<std::size_t>(hex_digit(static_cast<char>(request[asked])));
}

std::vector<Protocol::Place> places(const Protocol::Written& written) {
  const auto within = [](const auto& ranges, std::uint32_t word) {
    return std::ranges::any_of(
        ranges, [word](const auto& range) { return range.first <= word && word <= range.last; });
  };
  std::vector<Protocol::Place> runs;
  bool joined = false;
  for (std::uint32_t word = written.first_word; word <= std::min(written.last_word, 0xFFFFu);
       ++word) {
    const bool fixed = within(read_only, word), known = within(ls_bus::inverter_ranges(), word);
    joined = joined && !fixed && runs.back().declared == known;
    if (joined)
      runs.back().digits += digits_of_a_word;
    else if (!fixed)
      runs.push_back({hex_number(word, digits_of_a_word), digits_of_a_word, known});
    joined = !fixed;
  }
  return runs;
}

std::optional<Protocol::Written> named(std::string_view address, std::size_t digits) {
  const Result<std::vector<Part>> parts = parts_of(address, digits);
  if (!parts) return std::nullopt;
  const std::uint32_t first = *value_of(parts->front().address);
  const auto words = static_cast<std::uint32_t>(digits / digits_of_a_word);
  return Protocol::Written{std::string(parameter_area), first, first + words - 1,
                           std::string(address)};
}

std::optional<std::string> moved(std::string_view address, int words) {
  const std::string prefix(
      address.starts_with('h') || address.starts_with('H') ? address.substr(0, 1) : "");
  const std::optional<std::uint32_t> value = value_of(address.substr(prefix.size()));
  if (!value) return std::nullopt;
  const std::int64_t sum = std::int64_t{*value} + words;
  if (sum < 0 || sum > 0xFFFF) return std::nullopt;
  return prefix + hex_number(static_cast<std::uint64_t>(sum), digits_of_a_word);
}

std::vector<Protocol::AddressField> address_fields(ByteView frame, bool count_first) {
  constexpr std::size_t body_at = 4;
  if (frame.size() < body_at || frame[0] != enq) return {};
  if (frame[3] == 'W' || frame[3] == 'w') {
    for (const WriteReading& reading : write_readings(frame))
      if (reading.count_first == count_first) {
        const std::uint32_t first = *value_of(reading.address);
        return {{body_at + (count_first ? 1 : 0),
                 digits_of_a_word,
                 {std::string(parameter_area), first, first + reading.words - 1, reading.address}}};
      }
    return {};
  }
  for (const harness::Field& field : explain(frame)) {
    if (field.name != "address") continue;
    const std::optional<std::uint32_t> first = value_of(field.text);
    const int words =
        frame.size() > body_at + digits_of_a_word
            ? std::max(1, hex_digit(static_cast<char>(frame[body_at + digits_of_a_word])))
            : 1;
    if (first)
      return {{field.offset,
               field.size,
               {std::string(parameter_area), *first, *first + static_cast<std::uint32_t>(words) - 1,
                field.text}}};
  }
  return {};
}

std::vector<Protocol::Written> written_by(ByteView frame, std::optional<bool> order) {
  if (frame.size() < 4 || frame[0] != enq || (frame[3] != 'W' && frame[3] != 'w')) return {};
  std::vector<Protocol::Written> written;
  bool settled = false;  // the request adds up address first, and only so
  for (const WriteReading& reading : write_readings(frame)) {
    if (order ? reading.count_first != *order : reading.count_first && settled && !reading.adds_up)
      continue;
    settled = reading.adds_up;
    const std::uint32_t first = *value_of(reading.address);
    const std::string name =
        reading.count_first && !order ? reading.address + " (read count first)" : reading.address;
    written.push_back({std::string(parameter_area), first, first + reading.words - 1, name});
  }
  if (written.empty())
    written.push_back({"?", 0, std::numeric_limits<std::uint32_t>::max(), "an unknown place"});
  return written;
}

}  // namespace fieldproof::ls_bus_suite
