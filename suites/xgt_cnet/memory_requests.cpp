#include "suites/xgt_cnet/memory_requests.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>
#include <optional>

#include "harness/device_names.hpp"
#include "harness/notation/beginning.hpp"
#include "suites/xgt_cnet/frame_parts.hpp"

namespace fieldproof::xgt_cnet_suite {

using harness::Field;
using harness::Protocol;

namespace {

constexpr std::size_t max_bytes = 120;  // 60 words a request (Cnet EN 7.1.5)

/// "%MW100" taken apart.
struct Name {
  char area = 0, type = 0;
  std::string_view number;

  std::size_t element_bytes() const {
    return type == 'W' ? 2 : type == 'D' ? 4 : type == 'L' ? 8 : 1;
  }
};

std::optional<Name> read_name(std::string_view text) {
  if (text.size() < 4 || text[0] != '%') return std::nullopt;
  const Name name{static_cast<char>(std::toupper(text[1])),
                  static_cast<char>(std::toupper(text[2])), text.substr(3)};
  if (std::string_view("XBWDL").find(name.type) == std::string_view::npos) return std::nullopt;
  return name;
}

std::optional<std::uint32_t> read_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// First word that `count` elements from a name could touch, and the last.
struct Words {
  std::uint32_t first = 0, last = 0;
};

std::optional<Words> words_of(const Name& name, std::uint32_t count) {
  if (name.type == 'X') {
    // XBM, XBC: decimal word and one hex bit digit; XEC: flat bit index. Either may be meant.
    const std::optional<std::uint32_t> word =
        name.number.size() > 1 ? read_number(name.number.substr(0, name.number.size() - 1)) : 0;
    const std::optional<std::uint32_t> flat = read_number(name.number);
    if (!word) return std::nullopt;
    const std::uint32_t other = flat ? *flat / 16 : *word;
    return Words{std::min(*word, other), std::max(*word, other)};
  }
  const std::optional<std::uint32_t> index = read_number(name.number);
  if (!index || count == 0) return std::nullopt;
  const auto bytes = static_cast<std::uint32_t>(name.element_bytes());
  return Words{*index * bytes / 2, ((*index + count) * bytes - 1) / 2};
}

Protocol::Written written(const std::string& address, std::uint32_t count,
                          const plc::PlcModel* model) {
  if (model && count > 0)
    if (const plc::ParsedAddress parsed = plc::parse_address(*model, address))
      return harness::memory_of(*model, parsed.address, count, address);
  const std::optional<Name> name = read_name(address);
  const std::optional<Words> words = name ? words_of(*name, count) : std::nullopt;
  if (!words)
    return {name ? std::string(1, name->area) : "?", 0, ~0u,
            address};  // dotted or damaged: the whole area
  return {std::string(1, name->area), words->first, words->last, address};
}

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

/// The name of an element `step` further on.
Result<std::string> advance(const Name& name, std::size_t step) {
  const std::optional<std::uint32_t> index = read_number(name.number);
  if (!index)
    return fail(fmt::format("cannot count on from %{}{}{}", name.area, name.type, name.number));
  return fmt::format("%{}{}{}", name.area, name.type, *index + step);
}

struct Part {
  std::string name;
  std::string hex;        // write
  std::size_t count = 1;  // elements
};

/// Cuts `digits` of memory from `address` on into requests of at most 60 words.
Result<std::vector<Part>> parts_of(std::string_view address, std::size_t digits,
                                   std::string_view hex) {
  const std::optional<Name> name = read_name(address);
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
      Result<std::string> next = advance(*name, done);
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
      if (const std::optional<Bytes> value = from_hex(field.text)) count = value->front();
    if (field.name == "name")
      if (const std::optional<Name> name = read_name(field.text))
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
    if (is_name(field)) result.push_back(written(field.text, count, model));
  if (result.empty()) result.push_back({"?", 0, ~0u, "an unknown place"});
  return result;
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
