#include "harness/explore/counts.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <map>

namespace fieldproof::explore {

using harness::Field;
using harness::Protocol;

namespace {

constexpr std::array<std::string_view, 3> count_names{"block count", "count", "number of data"};
constexpr std::array<std::string_view, 4> says_what{"command", "command type", "function code",
                                                    "data type"};

bool is_one_of(const auto& names, const Field& field) {
  return std::ranges::find(names, field.name) != names.end();
}

/// 2 of "name 2"; 0: it has no number.
int number_of(const Field& field) {
  const std::size_t blank = field.name.rfind(' ');
  const bool numbered = blank != std::string::npos && blank + 1 < field.name.size() &&
                        std::ranges::all_of(field.name.substr(blank + 1),
                                            [](unsigned char c) { return std::isdigit(c) != 0; });
  return numbered ? std::atoi(field.name.c_str() + blank + 1) : 0;
}

struct Piece {
  std::size_t begin = 0, end = 0;
  ByteView in(ByteView frame) const { return frame.subspan(begin, end - begin); }
};

/// The same part of all blocks: a request may have first all names, and then all data.
using Section = std::map<int, Piece>;

std::vector<Section> sections_of(const std::vector<Field>& fields, std::size_t behind) {
  std::vector<Section> sections;
  for (const Field& field : fields) {
    const int block = number_of(field);
    if (field.offset < behind || block == 0) continue;
    if (sections.empty() || (block == 1 && sections.back().size() > 1)) sections.emplace_back();
    const auto [piece, is_new] = sections.back().try_emplace(block, Piece{field.offset, 0});
    piece->second.end = field.offset + field.size;
  }
  return sections;
}

void append(Bytes& bytes, ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); }

}  // namespace

bool is_data(const Field& field) {
  return field.name == "data" || (field.name.starts_with("data ") && number_of(field) > 0);
}

Counts::Counts(const Protocol& protocol, int station, const std::vector<Bytes>& requests)
    : protocol_(protocol), station_(station) {
  std::uint64_t low = 0, high = 0;  // counts are small numbers
  for (const Bytes& request : requests)
    if (const std::optional<Count> count = count_in(request)) {
      const ByteView bytes = ByteView(request).subspan(count->field.offset, count->field.size);
      low += number(bytes, true);
      high += number(bytes, false);
    }
  low_first_ = !protocol.is_text() && low < high;
}

std::vector<Field> Counts::fields_of(ByteView request) const {
  std::vector<Field> fields = protocol_.explain_as(request, true);
  std::erase_if(fields, [&](const Field& one) {
    return one.size == 0 || one.offset + one.size > request.size();
  });
  return fields;
}

std::uint32_t Counts::number(ByteView digits, bool low_first) const {
  if (protocol_.is_text())
    return static_cast<std::uint32_t>(std::strtoul(to_text(digits).c_str(), nullptr, 16));
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < digits.size(); ++i)
    value = value << 8 | digits[low_first ? digits.size() - 1 - i : i];
  return value;
}

Bytes Counts::digits(std::uint32_t value, std::size_t size) const {
  Bytes bytes(size);
  const std::uint32_t base = protocol_.is_text() ? 16 : 256;
  for (std::size_t i = 0; i < size; ++i, value /= base) {
    const std::uint32_t digit = value % base;
    bytes[low_first_ ? i : size - 1 - i] = protocol_.is_text()
                                               ? static_cast<Byte>("0123456789ABCDEF"[digit])
                                               : static_cast<Byte>(digit);
  }
  return bytes;
}

std::optional<Count> Counts::count_in(ByteView request) const {
  for (const Field& field : fields_of(request))
    if (is_one_of(count_names, field))
      return Count{field, number(request.subspan(field.offset, field.size), low_first_)};
  return std::nullopt;
}

std::string Counts::service_of(ByteView request) const {
  std::string service;
  for (const Field& field : fields_of(request))
    if (is_one_of(says_what, field)) service += (service.empty() ? "" : " ") + field.text;
  return service;
}

std::optional<Bytes> Counts::resized(ByteView request, std::uint32_t count, Random& random) const {
  const std::optional<Count> had = count_in(request);
  if (!had || had->value == 0 || count == had->value) return std::nullopt;
  std::optional<Bytes> made = had->field.name == "block count"
                                  ? with_blocks(request, *had, count, random)
                                  : with_data(request, *had, count, random);
  if (made) return with_checks(std::move(*made));
  return std::nullopt;
}

std::optional<Bytes> Counts::with_blocks(ByteView request, const Count& had, std::uint32_t count,
                                         Random& random) const {
  const std::size_t behind = had.field.offset + had.field.size;
  const std::vector<Section> sections = sections_of(fields_of(request), behind);
  if (sections.empty()) return std::nullopt;
  for (const Section& section : sections)
    if (section.size() != had.value) return std::nullopt;
  std::vector<int> chosen(count);
  for (int& block : chosen) block = 1 + static_cast<int>(random.below(had.value));
  Bytes made;
  append(made, request.first(had.field.offset));
  append(made, digits(count, had.field.size));
  std::size_t at = behind;
  for (const Section& section : sections) {
    append(made, request.subspan(at, section.begin()->second.begin - at));
    for (const int block : chosen) append(made, section.at(block).in(request));
    at = section.rbegin()->second.end;
  }
  append(made, request.subspan(at));
  return made;
}

std::optional<Bytes> Counts::with_data(ByteView request, const Count& had, std::uint32_t count,
                                       Random& random) const {
  const std::vector<Field> fields = fields_of(request);
  std::optional<Piece> data;
  std::optional<Field> bytes;
  for (const Field& field : fields) {
    if (field.name == "byte count") bytes = field;
    if (!is_data(field)) continue;
    if (!data) data = Piece{field.offset, 0};
    data->end = field.offset + field.size;
  }
  Bytes made(request.begin(), request.end());
  const auto put = [&](const Field& field, std::uint32_t value) {
    std::ranges::copy(digits(value, field.size),
                      made.begin() + static_cast<std::ptrdiff_t>(field.offset));
  };
  put(had.field, count);
  if (!data) return made;
  const std::size_t size = data->end - data->begin;
  const std::size_t a_byte = protocol_.is_text() ? 2 : 1;
  const std::size_t room =
      size % had.value == 0 ? size / had.value * count : (count + 7) / 8 * a_byte;  // bits
  if (bytes) put(*bytes, static_cast<std::uint32_t>(room / a_byte));
  Bytes filled;
  while (filled.size() < room) filled.push_back(request[data->begin + random.below(size)]);
  made.erase(made.begin() + static_cast<std::ptrdiff_t>(data->begin),
             made.begin() + static_cast<std::ptrdiff_t>(data->end));
  made.insert(made.begin() + static_cast<std::ptrdiff_t>(data->begin), filled.begin(),
              filled.end());
  return made;
}

Bytes Counts::with_checks(Bytes request) const {
  const notation::Checks checks = protocol_.checks();
  for (const Field& field : fields_of(request)) {
    const notation::Check* check = notation::find_check(checks, field.name);
    if (!check || check->size != field.size || !check->compute ||
        (check->absent && check->absent(request)))
      continue;
    const ByteView whole = request;
    const Bytes right = check->over(check->behind ? whole.subspan(field.offset + field.size)
                                                  : whole.first(field.offset));
    if (right.size() == field.size)
      std::ranges::copy(right, request.begin() + static_cast<std::ptrdiff_t>(field.offset));
  }
  return request;
}

}  // namespace fieldproof::explore
