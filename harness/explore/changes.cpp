#include "harness/explore/changes.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cctype>

#include "harness/explore/damage.hpp"

namespace fieldproof::explore {

using harness::Field;
using harness::Protocol;
using safety::Bracket;

namespace {

constexpr std::string_view digits = "0123456789ABCDEF";

bool is_digit(Byte byte) { return digits.find(static_cast<char>(byte)) != std::string_view::npos; }

Byte any_digit(Random& random) { return static_cast<Byte>(digits[random.below(digits.size())]); }

/// Digits stay digits.
Bytes any_data(ByteView old, bool text, Random& random) {
  Bytes bytes(old.begin(), old.end());
  for (Byte& byte : bytes)
    if (!text)
      byte = static_cast<Byte>(random.below(256));
    else if (is_digit(byte))
      byte = any_digit(random);
  return bytes;
}

/// As any_data, but what may be a bit stays one: 00 or 01.
Bytes right_data(ByteView old, bool text, Random& random) {
  const Byte zero = text ? '0' : 0;
  const bool one = old.size() == 1 || (text && old.size() == 2 && old.front() == zero);
  const bool bit = one && (old.back() == zero || old.back() == zero + 1);
  if (!bit) return any_data(old, text, random);
  Bytes bytes(old.begin(), old.end());
  bytes.back() = static_cast<Byte>(zero + random.below(2));
  return bytes;
}

/// A number of hex digits, or of bytes with the low one in front or behind, `by` further.
Bytes counted(ByteView old, bool text, bool low_first, int by) {
  Bytes bytes(old.begin(), old.end());
  const auto at = [&](std::size_t i) -> Byte& {
    return bytes[low_first ? i : bytes.size() - 1 - i];
  };
  int carry = by;
  for (std::size_t i = 0; i < bytes.size() && carry != 0; ++i) {
    const int base = text ? 16 : 256;
    const std::size_t digit = text ? digits.find(static_cast<char>(at(i))) : at(i);
    if (digit == std::string_view::npos) return bytes;
    const int sum = static_cast<int>(digit) + carry;
    const int value = (sum % base + base) % base;
    carry = (sum - value) / base;
    at(i) = text ? static_cast<Byte>(digits[static_cast<std::size_t>(value)])
                 : static_cast<Byte>(value);
  }
  return bytes;
}

}  // namespace

std::optional<std::uint32_t> HotWords::word(const std::string& area, Random& random) {
  const std::vector<safety::WriteFence::Words> room = room_(area);
  if (room.empty()) return std::nullopt;
  const safety::WriteFence::Words& range = random.of(room);
  const std::uint32_t size = range.last - range.first + 1;
  const auto any = [&] { return range.first + static_cast<std::uint32_t>(random.below(size)); };
  const auto inside = [&](std::uint32_t word) {
    const bool there = std::ranges::any_of(
        room, [&](const auto& one) { return one.first <= word && word <= one.last; });
    return there ? word : any();
  };
  const auto [hot, fresh] = words_.try_emplace(area, 0);
  if (fresh) hot->second = any();
  switch (random.below(10)) {
    case 0: return any();
    case 1: return range.last - static_cast<std::uint32_t>(random.below(std::min(size, 4u)));
    case 2: return inside(hot->second ^ (1u << random.below(16)));
    default: return inside(hot->second + static_cast<std::uint32_t>(random.below(4)));
  }
}

bool Changes::make(std::string_view kind, Request& request, HotWords& hot, Random& random) const {
  bool done = false;
  if (kind == "elsewhere") done = elsewhere(request, hot, random);
  if (kind == "field") done = field(request, random);
  if (kind == "damage") done = damage(request, random);
  if (kind == "pause") done = pause(request, random);
  if (kind == "resized") done = resized(request, std::nullopt, random);
  if (kind == "letters") done = letters(request, random);
  if (kind == "order") done = order(request, random);
  if (kind == "station") done = station(request, random);
  if (kind == "twice") done = twice(request);
  if (done) request.kind = kind;
  return done;
}

bool Changes::move(Request& request, const Bracket& bracket, HotWords& hot, Random& random) const {
  bool moved = false;
  for (const Protocol::AddressField& address : bracket.fields) {
    const Protocol::Written& names = address.names;
    if (address.size == 0 || names.unknown()) continue;
    std::optional<Bytes> bytes;  // of as many digits as there are
    for (int trial = 0; trial < 4 && !bytes; ++trial) {
      const std::optional<std::uint32_t> to = hot.word(names.area, random);
      if (!to) break;
      const int by = static_cast<int>(*to) - static_cast<int>(names.first_word);
      bytes = protocol_.moved_field(bracket.bytes, address, by);
    }
    moved |= bytes && safety::patch(request.notation, bracket, address.offset, *bytes, fields_);
  }
  return moved;
}

bool Changes::elsewhere(Request& request, HotWords& hot, Random& random) const {
  bool changed = false;
  for (const Bracket& bracket : safety::brackets_of(request.notation, false, fields_, protocol_)) {
    changed |= move(request, bracket, hot, random);
    for (const Field& field : protocol_.explain_as(bracket.bytes, true))
      if (field.size > 0 && is_data(field)) {
        const ByteView old = ByteView(bracket.bytes).subspan(field.offset, field.size);
        changed |= safety::patch(request.notation, bracket, field.offset,
                                 right_data(old, protocol_.is_text(), random), fields_);
      }
  }
  return changed;
}

bool Changes::put(Request& request, const Bracket& bracket, const Field& field,
                  ByteView bytes) const {
  const ByteView old = ByteView(bracket.bytes).subspan(field.offset, field.size);
  if (std::ranges::equal(old, bytes) ||
      !safety::patch(request.notation, bracket, field.offset, bytes, fields_))
    return false;
  request.change = fmt::format("{}: {} becomes {}", field.name, notation::print_bytes(old),
                               notation::print_bytes(bytes));
  return true;
}

bool Changes::field(Request& request, Random& random) const {
  const std::vector<Bracket> brackets =
      safety::brackets_of(request.notation, false, fields_, protocol_);
  if (brackets.empty()) return false;
  const Bracket& bracket = random.of(brackets);
  std::vector<Field> fields = protocol_.explain_as(bracket.bytes, true);
  std::erase_if(fields, [&](const Field& one) {
    return one.size == 0 || one.offset + one.size > bracket.bytes.size();
  });
  if (fields.empty()) return false;
  const Field& field = random.of(fields);
  const ByteView old = ByteView(bracket.bytes).subspan(field.offset, field.size);
  const bool text = protocol_.is_text(), low_first = random.chance(50);
  switch (random.below(6)) {
    case 0: return put(request, bracket, field, counted(old, text, low_first, 1));
    case 1: return put(request, bracket, field, counted(old, text, low_first, -1));
    case 2: return put(request, bracket, field, Bytes(old.size(), text ? Byte{'0'} : Byte{0}));
    case 3: return put(request, bracket, field, Bytes(old.size(), text ? Byte{'F'} : Byte{0xFF}));
    case 4: {  // one byte of it
      Bytes bytes(old.begin(), old.end());
      random.of(bytes) = static_cast<Byte>(text ? 0x20 + random.below(0x5F) : random.below(256));
      return put(request, bracket, field, bytes);
    }
    default: return put(request, bracket, field, any_data(old, text, random));
  }
}

bool Changes::damage(Request& request, Random& random) const {
  const Result<Bytes> bytes = safety::bytes_of(request.notation, fields_);
  if (!bytes || bytes->empty()) return false;
  const std::size_t bits = protocol_.is_text() ? 7 : 8;
  const auto any_byte = [&] { return static_cast<Byte>(random.below(std::size_t{1} << bits)); };
  const std::size_t at = random.below(bytes->size());
  Damaged damaged;
  switch (random.below(6)) {
    case 0: damaged = flipped(*bytes, at, static_cast<unsigned>(random.below(bits))); break;
    case 1: damaged = dropped(*bytes, at); break;
    case 2: damaged = doubled(*bytes, at); break;
    case 3: damaged = cut(*bytes, at); break;
    case 4: damaged = with_byte_behind(*bytes, any_byte()); break;
    default: damaged = with_byte_before(*bytes, any_byte());
  }
  request.notation = std::move(damaged.notation);
  request.change = std::move(damaged.change);
  return !request.notation.empty();
}

bool Changes::pause(Request& request, Random& random) const {
  // On real time none that is as long as what a protocol waits for.
  static constexpr std::array<double, 7> pauses{200, 1500, 1, 3, 5, 10, 1000};
  const bool network = protocol_.on_network();
  const Result<Bytes> bytes = safety::bytes_of(request.notation, fields_);
  if (!bytes || bytes->size() < 2) return false;
  const std::size_t at = 1 + random.below(bytes->size() - 1);
  // None at all: there are two segments.
  const double pause =
      network && random.chance(33) ? 0 : pauses[random.below(line_ ? pauses.size() : 2)];
  Damaged damaged = paused(*bytes, at, {pause, false});
  request.notation = std::move(damaged.notation);
  request.change = std::move(damaged.change);
  return true;
}

bool Changes::resized(Request& request, std::optional<std::uint32_t> wish, Random& random) const {
  static constexpr std::array<std::uint32_t, 16> sizes{1,  2,  3,  8,   15,  16,  17,  32,
                                                       60, 61, 64, 120, 125, 126, 255, 513};
  const std::vector<Bracket> brackets =
      safety::brackets_of(request.notation, false, fields_, protocol_);
  if (brackets.size() != 1) return false;
  const std::optional<Count> had = counts_.count_in(brackets.front().bytes);
  if (!had) return false;
  constexpr std::uint32_t large = 64;  // takes its time to be made, and shows hardly more
  std::uint32_t count = random.of(sizes);
  if (random.chance(50) || (count > large && random.chance(80)))
    count = 1 + static_cast<std::uint32_t>(random.below(20));
  if (wish) count = *wish;
  constexpr std::uint32_t most_blocks = 40;  // each has a name
  if (had->field.name == "block count") count = std::min(count, most_blocks);
  const std::optional<Bytes> made = counts_.resized(brackets.front().bytes, count, random);
  if (!made || made->size() > 2 * protocol_.longest_frame()) return false;
  request.notation = notation_of(*made, true, protocol_, station_);
  request.change = fmt::format("{} {} becomes {}", had->field.name, had->value, count);
  return true;
}

bool Changes::letters(Request& request, Random& random) const {
  const std::vector<Bracket> brackets =
      safety::brackets_of(request.notation, false, fields_, protocol_);
  if (!protocol_.is_text() || brackets.empty()) return false;
  const Bracket& bracket = random.of(brackets);
  std::vector<Field> fields = protocol_.explain_as(bracket.bytes, true);
  std::erase_if(fields, [&](const Field& one) {
    const ByteView bytes = ByteView(bracket.bytes).subspan(one.offset, one.size);
    return notation::find_check(protocol_.checks(), one.name) ||
           std::ranges::none_of(bytes, [](Byte byte) { return std::isalpha(byte) != 0; });
  });
  if (fields.empty()) return false;
  const Field& field = random.of(fields);
  Bytes bytes(bracket.bytes.begin() + static_cast<std::ptrdiff_t>(field.offset),
              bracket.bytes.begin() + static_cast<std::ptrdiff_t>(field.offset + field.size));
  for (Byte& byte : bytes)
    if (std::isalpha(byte) != 0) byte = static_cast<Byte>(byte ^ 0x20);
  return put(request, bracket, field, bytes);
}

bool Changes::order(Request& request, Random& random) const {
  const Result<Bytes> whole = safety::bytes_of(request.notation, fields_);
  if (!whole) return false;
  std::vector<Field> fields = protocol_.explain_as(*whole, true);
  std::erase_if(fields, [&](const Field& one) {
    return one.size == 0 || one.offset + one.size > whole->size() ||
           notation::find_check(protocol_.checks(), one.name);
  });
  if (fields.size() < 2) return false;
  const std::size_t at = random.below(fields.size() - 1);
  const Field &first = fields[at], &second = fields[at + 1];
  if (first.offset + first.size != second.offset) return false;
  Bytes bytes = *whole;
  const auto place = [&](std::size_t offset) {
    return bytes.begin() + static_cast<std::ptrdiff_t>(offset);
  };
  std::rotate(place(first.offset), place(second.offset), place(second.offset + second.size));
  if (bytes == *whole) return false;
  request.notation = notation_of(counts_.with_checks(bytes), true, protocol_, station_);
  request.change = fmt::format("{} before {}", second.name, first.name);
  return true;
}

bool Changes::station(Request& request, Random& random) const {
  bool changed = false;
  const int by = 1 + static_cast<int>(random.below(30));
  for (notation::Item& item : request.notation) {
    if (item.kind != notation::Item::Kind::station || !line_) continue;
    item.number += by;
    changed = true;
  }
  request.change = fmt::format("to the station {} further", by);
  return changed && safety::bytes_of(request.notation, fields_);
}

bool Changes::twice(Request& request) const {
  const Result<Bytes> bytes = safety::bytes_of(request.notation, fields_);
  if (!bytes || bytes->empty() || bytes->size() > protocol_.longest_frame()) return false;
  Bytes both = *bytes;
  both.insert(both.end(), bytes->begin(), bytes->end());
  request.notation = raw_notation(both);
  request.change = "sent twice without a pause";
  return true;
}

std::optional<Request> Changes::with_registration(const Request& request, unsigned number) const {
  for (const Bracket& bracket : safety::brackets_of(request.notation, false, fields_, protocol_)) {
    const std::vector<Field> fields = protocol_.explain_as(bracket.bytes, true);
    const auto field = std::ranges::find(fields, "registration number", &Field::name);
    if (field == fields.end() || field->size != 2) continue;
    Request registers = request;
    const std::string digits = fmt::format("{:02X}", number);
    if (!safety::patch(registers.notation, bracket, field->offset, to_bytes(digits), fields_))
      continue;
    return registers;
  }
  return std::nullopt;
}

std::vector<Protocol::Written> Changes::named_by(const Request& request) const {
  std::vector<Protocol::Written> names;
  const auto add = [&](const std::vector<Protocol::AddressField>& fields) {
    for (const Protocol::AddressField& field : fields)
      if (!field.names.unknown()) names.push_back(field.names);
  };
  const std::vector<Bracket> brackets =
      safety::brackets_of(request.notation, false, fields_, protocol_);
  for (const Bracket& bracket : brackets) add(bracket.fields);
  const Result<Bytes> bytes = safety::bytes_of(request.notation, fields_);
  if (brackets.empty() && bytes) add(protocol_.address_fields(*bytes, false));
  return names;
}

std::optional<Request> Changes::look_at(const Request& request, Random& random) const {
  if (request.names.empty()) return std::nullopt;
  const Protocol::Written& names = random.of(request.names);
  const std::uint32_t words = protocol_.words_of(names.area);
  const std::uint32_t beside = random.chance(25) ? 1 : 0;
  const std::uint32_t word =
      names.first_word +
      static_cast<std::uint32_t>(random.below(names.last_word - names.first_word + 1)) + beside;
  if (words != 0 && word >= words) return std::nullopt;
  return read(request, {names.area, word, word, "", names.contacts});
}

std::optional<Request> Changes::look_anywhere(Request like, HotWords& hot, Random& random) const {
  std::vector<Protocol::Area> areas = protocol_.areas();
  std::erase_if(areas, [&](const auto& one) { return protocol_.words_of(one.name) == 0; });
  if (areas.empty()) return std::nullopt;
  const std::string& area = random.of(areas).name;
  const std::optional<std::uint32_t> word = hot.word(area, random);
  if (!word) return std::nullopt;
  return read(std::move(like), {area, *word, *word, ""});
}

std::optional<Request> Changes::look_past(Request like, Random& random) const {
  std::vector<Protocol::Area> areas = protocol_.areas();
  std::erase_if(areas, [&](const auto& one) { return protocol_.words_of(one.name) == 0; });
  if (areas.empty()) return std::nullopt;
  const std::string& area = random.of(areas).name;
  const std::uint32_t word = protocol_.words_of(area) +
                             static_cast<std::uint32_t>(random.chance(70) ? 0 : random.below(64));
  std::optional<Request> look = read(std::move(like), {area, word, word, ""}, false);
  if (look) look->kind = "past";
  return look;
}

std::optional<Request> Changes::read(Request like, const Protocol::Written& names,
                                     bool declared) const {
  const std::optional<Protocol::Place> place = place_of(names, protocol_);
  if (!place || place->declared != declared) return std::nullopt;
  const Result<std::vector<Bytes>> reads =
      protocol_.read_requests(station_, place->address, place->digits);
  if (!reads || reads->empty()) return std::nullopt;
  like.notation = notation_of(reads->front(), true, protocol_, station_);
  like.kind = "look";
  like.change.clear();
  like.names = {names};
  return like;
}

}  // namespace fieldproof::explore
