#include "suites/xgt_cnet/memory_requests.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>
#include <optional>
#include <utility>

#include "harness/device_names.hpp"
#include "harness/notation/beginning.hpp"
#include "suites/xgt_cnet/frame_parts.hpp"

namespace fieldproof::xgt_cnet_suite {

using harness::ElementName;
using harness::Field;
using harness::Protocol;

namespace {

// A request may have 60 words (Cnet EN 7.1.5), but a frame with a long name 256 bytes at most
// (7.1.2, note 3).
constexpr std::size_t max_bytes = 112;

constexpr std::size_t command_at = 3, frame_head = 6;  // header, station, command and its type

/// In lower case, with a BCC (Cnet EN 7.1.3).
Bytes request(std::string_view station, std::string_view command, std::string_view rest) {
  Bytes frame = to_bytes(fmt::format("\x05{}{}{}\x04", station, command, rest));
  const unsigned sum = std::accumulate(frame.begin(), frame.end(), 0u);
  for (const char digit : hex_number(sum & 0xFF, 2)) frame.push_back(static_cast<Byte>(digit));
  return frame;
}

std::string with_length(std::string_view name) {
  return hex_number(name.size(), 2) + std::string(name);
}

struct Part {
  std::string name;
  std::string hex;        // write
  std::size_t count = 1;  // elements
};

/// Cuts `digits` of memory from `address` on into requests of at most 56 words.
Result<std::vector<Part>> parts_of(std::string_view address, std::size_t digits,
                                   std::string_view hex) {
  const std::optional<ElementName> name = harness::read_element_name(address);
  if (!name) return fail(fmt::format("'{}' is no device name such as %MW100", address));
  const std::size_t element = name->element_bytes() * 2;
  if (digits == 0 || digits % element != 0)
    return fail(fmt::format("{} digits are not a whole number of elements of {} ({} digits each)",
                            digits, address, element));
  const std::size_t count = digits / element;
  if (name->type == 'X' && count > 1)
    return fail(fmt::format("{}: several bits at once; name each bit", address));
  const std::size_t at_once = max_bytes / name->element_bytes();
  std::vector<Part> parts;
  for (std::size_t done = 0; done < count; done += at_once) {
    Part part{std::string(address), "", std::min(at_once, count - done)};
    if (done > 0) {
      Result<std::string> next = harness::element_further_on(*name, done);
      if (!next) return next.error();
      part.name = *next;
    }
    if (!hex.empty()) part.hex = hex.substr(done * element, part.count * element);
    parts.push_back(std::move(part));
  }
  return parts;
}

std::optional<std::string> refusal(ByteView reply) {
  if (reply.empty()) return "no answer";
  if (reply[0] == 0x15) {
    for (const Field& field : explain(reply))
      if (field.name == "error code") return "the device answers NAK " + field.text;
    return "the device answers NAK";
  }
  if (reply[0] != 0x06)
    return "the answer is neither ACK nor NAK: " + notation::print_beginning(reply);
  return std::nullopt;
}

}  // namespace

Result<std::vector<Bytes>> write_requests(std::string_view station, std::string_view address,
                                          std::string_view hex) {
  if (address.size() > 1 && (std::toupper(address[1]) == 'F' || std::toupper(address[1]) == 'N'))
    return fail(fmt::format("{} is read only over the protocol", address));
  if (address.starts_with('@'))
    return fail(fmt::format("{} is a counter, which no command writes", address));
  const Result<std::vector<Part>> parts = parts_of(address, hex.size(), hex);
  if (!parts) return parts.error();
  std::vector<Bytes> requests;
  for (const Part& part : *parts) {
    if (part.count == 1)
      requests.push_back(request(station, "wSS", "01" + with_length(part.name) + part.hex));
    else
      requests.push_back(
          request(station, "wSB", with_length(part.name) + hex_number(part.count, 2) + part.hex));
  }
  return requests;
}

Result<std::vector<Bytes>> read_requests(std::string_view station, std::string_view address,
                                         std::size_t digits) {
  if (address.starts_with('@'))
    return fail(fmt::format("{} is a counter, which no command reads", address));
  const Result<std::vector<Part>> parts = parts_of(address, digits, "");
  if (!parts) return parts.error();
  std::vector<Bytes> requests;
  for (const Part& part : *parts) {
    if (part.count == 1)
      requests.push_back(request(station, "rSS", "01" + with_length(part.name)));
    else
      requests.push_back(
          request(station, "rSB", with_length(part.name) + hex_number(part.count, 2)));
  }
  return requests;
}

Status write_reply(ByteView reply) {
  if (const std::optional<std::string> why = refusal(reply)) return fail(*why);
  return ok();
}

Result<std::string> read_reply(ByteView reply) {
  if (const std::optional<std::string> why = refusal(reply)) return fail(*why);
  std::string digits;
  for (const Field& field : explain(reply))
    if (field.name == "data") digits += field.text;
  if (digits.empty()) return fail("the answer holds no data");
  return digits;
}

namespace {

/// Digits that the data fields of a reply hold.
std::size_t digits_of_data(ByteView reply) {
  std::size_t count = 0;
  for (const Field& field : explain(reply))
    if (field.name == "data") count += field.size;
  return count;
}

/// Digits that a read request of this room asks for; 0: it reads nothing.
std::size_t digits_asked_for(ByteView request) {
  std::size_t count = 1, element = 0;
  for (const Field& field : explain(request)) {
    if (field.name == "number of data")
      if (const std::optional<Bytes> value = from_hex(field.text); value && value->size() == 1)
        count = value->front();
    if (field.name == "name")
      if (const std::optional<ElementName> name = harness::read_element_name(field.text))
        element = name->element_bytes() * 2;
  }
  return request[command_at] == 'r' || request[command_at] == 'R' ? count * element : 0;
}

}  // namespace

bool answers(ByteView request, ByteView reply) {
  if (request.size() < frame_head || reply.size() < frame_head) return false;
  if (!std::ranges::equal(request.subspan(1, frame_head - 1), reply.subspan(1, frame_head - 1)))
    return false;
  return reply[0] == nak || digits_of_data(reply) == digits_asked_for(request);
}

bool is_checked(ByteView request) {
  return request.size() > command_at && std::islower(request[command_at]);
}

Bytes without_check(ByteView request) {
  if (!is_checked(request)) return {};
  const auto tail = std::ranges::find(request, eot);
  if (tail == request.end()) return {};
  Bytes plain(request.begin(), std::next(tail));
  plain[command_at] = static_cast<Byte>(std::toupper(plain[command_at]));
  return plain;
}

namespace {

bool is_name(const Field& field) {
  return field.name.starts_with("name") && !field.name.starts_with("name length");
}

/// "number of data" of a continuous request, else one element a name.
std::uint32_t elements_a_name(const std::vector<Field>& fields) {
  for (const Field& field : fields) {
    if (field.name != "number of data") continue;
    const std::optional<Bytes> value = from_hex(field.text);
    return value && value->size() == 1 ? value->front() : 0;
  }
  return 1;
}

}  // namespace

std::vector<Protocol::Written> written_by(ByteView frame, const plc::PlcModel* model) {
  if (frame.size() < 4 || frame[0] != 0x05 || std::toupper(frame[3]) != 'W') return {};
  std::vector<Protocol::Written> result;
  const std::vector<Field> fields = explain(frame);
  const std::uint32_t count = elements_a_name(fields);
  for (const Field& field : fields)
    if (is_name(field)) result.push_back(harness::memory_at(model, field.text, count));
  if (result.empty()) result.push_back({"?", 0, ~0u, "an unknown place"});
  return result;
}

/// Each name is followed by its data. A bit that is set to anything but 0 or 1 reads otherwise.
std::vector<std::pair<std::string, std::string>> sets(ByteView request) {
  std::vector<std::pair<std::string, std::string>> all;
  if (written_by(request).empty()) return all;
  std::string name;
  for (const Field& field : explain(request)) {
    if (is_name(field)) name = field.text;
    if (!field.name.starts_with("data")) continue;
    const bool bit = name.size() > 2 && std::toupper(name[2]) == 'X';
    if (name.empty() || !from_hex(field.text)) return {};
    if (bit && field.text != "00" && field.text != "01") return {};
    all.emplace_back(std::exchange(name, {}), field.text);
  }
  return all;
}

std::vector<Protocol::AddressField> address_fields(ByteView request, const plc::PlcModel& model) {
  std::vector<Protocol::AddressField> result;
  const std::vector<Field> fields = explain(request);
  const std::uint32_t count = elements_a_name(fields);
  for (const Field& field : fields) {
    const plc::ParsedAddress parsed = is_name(field)
                                          ? plc::parse_address(model, field.text)
                                          : plc::ParsedAddress{plc::AddressFault::form, {}};
    if (parsed)
      result.push_back(
          {field.offset, field.size, harness::memory_of(model, parsed.address, count, field.text)});
  }
  return result;
}

}  // namespace fieldproof::xgt_cnet_suite
