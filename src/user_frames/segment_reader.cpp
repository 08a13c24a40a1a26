#include "src/user_frames/segment_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "src/base/spelling.hpp"
#include "src/plc/config_reader.hpp"
#include "src/user_frames/variable.hpp"

namespace fieldproof::user_frames {

namespace {

std::string printed(const Json& value) {
  return value.dump(-1, ' ', true, Json::error_handler_t::replace);
}

Result<std::size_t> size_of(const Json& value, const Place& place, const char* key) {
  if (value.is_number_integer() && value >= 1 && value <= max_frame)
    return value.get<std::size_t>();
  return wrong(place.text, fmt::format("{} is {}, which is not a number of bytes from 1 to {}", key,
                                       printed(value), max_frame));
}

Status read_constant(const Json& value, const Place& place, bool hex, Segment& to) {
  const Result<std::string> text = text_of(value, place.text, hex ? "hex" : "text");
  if (!text) return text.error();
  if (hex) {
    const std::optional<Bytes> bytes = from_hex(*text);
    if (!bytes)
      return wrong(
          place.text,
          fmt::format("hex is '{}', which are no hex bytes; write such as \"0D 0A\"", *text));
    to.bytes = *bytes;
  } else {
    const bool ascii = std::ranges::all_of(*text, [](char c) { return c > 0; });
    if (!ascii)
      return wrong(place.text, "text holds characters that are not ASCII; write them as hex");
    to.bytes = to_bytes(*text);
  }
  to.size = to.bytes.size();
  if (to.size >= 1 && to.size <= max_constant) return ok();
  return wrong(place.text,
               fmt::format("the constant has {} bytes; a segment holds 1 to {}: split it", to.size,
                           max_constant));
}

Status read_memory(const Json& value, const Place& place, Segment& to) {
  if (value.value("memory", Json()) == true) {
    to.in_block = true;
    return ok();
  }
  const Result<std::string> address = text_of(value, place.text, "memory");
  if (!address) return address.error();
  if (!value.contains("memory"))
    return place.sent ? wrong(place.text,
                              "there is no memory; name where the bytes come from, such as %MW100, "
                              "or true: as a P2P block says")
                      : ok();
  const plc::ParsedAddress parsed = plc::parse_address(place.plc, *address);
  if (!parsed)
    return wrong(place.text, fmt::format("memory '{}' is wrong on {}: {}", *address, place.plc.name,
                                         plc::describe(parsed.fault)));
  if (parsed.address.type == 'X')
    return wrong(place.text,
                 fmt::format("memory '{}' is a bit; name bytes or words such as %MB200 or %MW100",
                             *address));
  if (!place.sent && !place.plc.areas[parsed.address.area].write)
    return wrong(
        place.text,
        fmt::format("memory '{}' is read only; received data cannot be stored there", *address));
  to.memory = parsed.address;
  to.address = *address;
  return ok();
}

Status read_conversion(const Json& value, const Place& place, Segment& to) {
  const Result<std::string> convert = text_of(value, place.text, "convert", "none");
  if (!convert) return convert.error();
  if (*convert == "hex_to_ascii")
    to.convert = Convert::hex_to_ascii;
  else if (*convert == "ascii_to_hex")
    to.convert = Convert::ascii_to_hex;
  else if (*convert != "none")
    return wrong(place.text,
                 fmt::format("convert is '{}'; use hex_to_ascii, ascii_to_hex or none", *convert));
  const Json swap = value.value("swap", Json(1));
  if (swap != 1 && swap != 2 && swap != 4 && swap != 8)
    return wrong(place.text, fmt::format("swap is {}; use 2, 4 or 8", printed(swap)));
  to.swap = swap.get<std::size_t>();
  return ok();
}

/// `stated` is the size in the definition: bytes of memory of a sent frame, of the frame of a
/// received one.
Status settle_sizes(const Place& place, std::size_t stated, Segment& to) {
  if (to.convert == Convert::ascii_to_hex && stated % 2 != 0)
    return wrong(place.text,
                 fmt::format("{} bytes are no pairs of hex digits; give an even size", stated));
  const std::size_t converted_size = to.convert == Convert::none           ? stated
                                     : to.convert == Convert::hex_to_ascii ? stated * 2
                                                                           : stated / 2;
  to.size = place.sent ? converted_size : stated;
  const std::size_t in_memory = place.sent ? stated : converted_size;
  if (in_memory % to.swap != 0)
    return wrong(place.text,
                 fmt::format("{} bytes of memory are no whole groups of {}, which swap turns round",
                             in_memory, to.swap));
  if (to.memory && !fits_bytes(place.plc, *to.memory, in_memory))
    return wrong(place.text, fmt::format("{} bytes from {} on: the area of {} ends before",
                                         in_memory, to.address, place.plc.name));
  return ok();
}

Status read_variable(const Json& value, const Place& place, const char* form, Segment& to) {
  if (place.area != Area::body)
    return wrong(place.text, fmt::format("{} stands in a {}; variables belong into a body", form,
                                         to_string(place.area)));
  if (Status read = read_memory(value, place, to); !read) return read;
  if (Status read = read_conversion(value, place, to); !read) return read;
  const bool fixed = std::string_view(form) == "fixed";
  if (fixed && place.sent)
    return wrong(place.text,
                 "fixed is for receive groups; write {\"variable\": SIZE, \"memory\": ...}");
  to.kind = Segment::Kind::data;
  if (!fixed && place.sent && to.in_block && value["variable"] == true) {
    to.kind = Segment::Kind::rest;
    return ok();
  }
  if (!fixed && !place.sent) {
    if (value["variable"] != true)
      return wrong(
          place.text,
          "a received variable has no size; write {\"variable\": true}, or {\"fixed\": SIZE}");
    to.kind = Segment::Kind::rest;
    return ok();
  }
  const Result<std::size_t> stated = size_of(value[form], place, form);
  if (!stated) return stated.error();
  return settle_sizes(place, *stated, to);
}

std::string method_names() {
  std::string names;
  for (const CheckMethodFacts& facts : check_methods())
    names += (names.empty() ? "" : ", ") + std::string(facts.name);
  return names;
}

Status read_check(const Json& value, const Place& place, Segment& to) {
  if (place.area != Area::tail)
    return wrong(place.text, fmt::format("a check stands in a {}; it belongs into the tail",
                                         to_string(place.area)));
  const Result<std::string> name = text_of(value, place.text, "check");
  if (!name) return name.error();
  const CheckMethodFacts* facts = find_check_method(*name);
  if (!facts) {
    std::vector<std::string_view> names;
    for (const CheckMethodFacts& one : check_methods()) names.push_back(one.name);
    return wrong(place.text, fmt::format("there is no check '{}'; the checks are {}{}", *name,
                                         method_names(), suggestion(*name, names)));
  }
  if (facts->bytes == 0)
    return wrong(
        place.text,
        fmt::format(
            "check '{}': neither the manuals nor a source that we know print its algorithm, and "
            "none is made up; use another check",
            *name));
  if (facts->dedicated)
    for (const char* key : {"start", "end", "ascii", "initial", "order"})
      if (value.contains(key))
        return wrong(
            place.text,
            fmt::format("check '{}' covers what its protocol says; remove '{}'", *name, key));
  const Json ascii = value.value("ascii", Json(false));
  if (!ascii.is_boolean())
    return wrong(place.text,
                 fmt::format("ascii is {}, which is not true or false", printed(ascii)));
  const Result<std::string> initial =
      text_of(value, place.text, "initial", facts->start == 0 ? "00" : "FF");
  if (!initial) return initial.error();
  if (*initial != "00" && *initial != "FF")
    return wrong(place.text, fmt::format("initial is '{}'; use 00 or FF", *initial));
  const Result<std::string> order = text_of(value, place.text, "order", "low_first");
  if (!order) return order.error();
  if (*order != "low_first" && *order != "high_first")
    return wrong(place.text, fmt::format("order is '{}'; use low_first or high_first", *order));
  if (facts->bytes == 1 && value.contains("order"))
    return wrong(place.text, fmt::format("check '{}' is one byte; remove 'order'", *name));
  to.kind = Segment::Kind::check;
  to.method = facts->method;
  const std::uint16_t all_ones = facts->bytes == 2 ? 0xFFFF : 0xFF;
  to.options = {*initial == "FF" ? all_ones : std::uint16_t{0}, ascii.get<bool>(),
                *order == "low_first"};
  to.size = check_size(to.method, to.options.ascii);
  return ok();
}

/// Position of "body.2"; nothing where there is no such segment.
std::optional<std::size_t> find_segment(const std::vector<Segment>& segments,
                                        const std::string& name) {
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (fmt::format("{}.{}", to_string(segments[i].area), segments[i].index) == name) return i;
  return std::nullopt;
}

std::optional<std::size_t> last_of_area(const std::vector<Segment>& segments,
                                        const std::string& area) {
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (to_string(segments[i].area) == area) last = i;
  return last;
}

Bytes constants_of(const std::vector<Segment>& segments, Area area, std::size_t before) {
  Bytes bytes;
  for (std::size_t i = 0; i < before; ++i)
    if (segments[i].area == area)
      bytes.insert(bytes.end(), segments[i].bytes.begin(), segments[i].bytes.end());
  return bytes;
}

Status settle_dedicated(std::vector<Segment>& segments, std::size_t position,
                        const std::string& place) {
  Segment& check = segments[position];
  const Bytes begin{0x10, 0x02}, end{0x10, 0x03};
  const Bytes head = constants_of(segments, Area::head, position);
  const bool df1 = check.method == CheckMethod::dle_ab;
  if (df1 && !(head.size() >= 2 && std::equal(begin.begin(), begin.end(), head.end() - 2)))
    return wrong(place, "check 'dle_ab' covers what follows DLE STX; end the head with hex 10 02");
  if (constants_of(segments, Area::tail, position) != end)
    return wrong(place, fmt::format("check '{}' follows DLE ETX; begin the tail with hex 10 03",
                                    facts_of(check.method).name));
  const auto body = std::ranges::find(segments, Area::body, &Segment::area);
  check.first = static_cast<std::size_t>(body - segments.begin());
  check.last = df1 ? *last_of_area(segments, "body") : position - 1;
  return ok();
}

}  // namespace

Error wrong(const std::string& place, const std::string& what) {
  return fail(fmt::format("cannot read {}: {}", place, what));
}

Status check_keys(const Json& object, const std::string& place,
                  std::initializer_list<std::string_view> keys) {
  return plc::known_keys(nlohmann::json(object), place, std::span(keys.begin(), keys.size()));
}

Result<std::string> text_of(const Json& object, const std::string& place, const char* key,
                            const std::string& fallback) {
  const auto found = object.find(key);
  if (found == object.end()) return fallback;
  if (found->is_string()) return found->get<std::string>();
  return wrong(place, fmt::format("{} is {}, which is no text", key, printed(*found)));
}

Result<Segment> read_segment(const Json& value, const Place& place) {
  Status keys = check_keys(value, place.text,
                           {"ascii", "check", "convert", "end", "fixed", "hex", "initial", "memory",
                            "name", "order", "start", "swap", "text", "variable"});
  if (!keys) return keys.error();
  const char* form = nullptr;
  for (const char* one : {"hex", "text", "fixed", "variable", "check"}) {
    if (!value.contains(one)) continue;
    if (form)
      return wrong(place.text,
                   fmt::format("it has {} and {}; a segment is one of them", form, one));
    form = one;
  }
  if (!form)
    return wrong(place.text,
                 "it has none of hex, text, fixed, variable and check; a segment is one of them");
  const std::string_view kind = form;
  const bool constant = kind == "hex" || kind == "text", check = kind == "check";
  if (constant)
    keys = check_keys(value, place.text, {form, "name"});
  else if (check)
    keys =
        check_keys(value, place.text, {form, "ascii", "end", "initial", "name", "order", "start"});
  else
    keys = check_keys(value, place.text, {form, "convert", "memory", "name", "swap"});
  if (!keys) return keys.error();

  const Result<std::string> name =
      text_of(value, place.text, "name", fmt::format("{} {}", to_string(place.area), place.index));
  if (!name) return name.error();
  Segment segment;
  segment.area = place.area;
  segment.index = place.index;
  segment.name = *name;
  const Status read = constant ? read_constant(value, place, kind == "hex", segment)
                      : check  ? read_check(value, place, segment)
                               : read_variable(value, place, form, segment);
  if (!read) return read.error();
  return segment;
}

Status settle_check(std::vector<Segment>& segments, std::size_t position, const Json& value,
                    const std::string& place) {
  Segment& check = segments[position];
  if (facts_of(check.method).dedicated) return settle_dedicated(segments, position, place);
  const Result<std::string> start = text_of(value, place, "start"),
                            end = text_of(value, place, "end", "before_check");
  if (!start) return start.error();
  if (!end) return end.error();
  const std::optional<std::size_t> first = start->empty() ? 0 : find_segment(segments, *start);
  if (!first)
    return wrong(place, fmt::format("start is '{}'; there is no such segment: write such as head.0",
                                    *start));
  std::optional<std::size_t> last =
      *end == "before_check" ? position - 1 : last_of_area(segments, *end);
  if (!last) last = find_segment(segments, *end);
  if (!last)
    return wrong(
        place,
        fmt::format("end is '{}'; write before_check, head, body, or a segment such as body.2",
                    *end));
  if (*last >= position)
    return wrong(place,
                 fmt::format("end is '{}', and the check would cover itself; end before it", *end));
  if (*last < *first) return wrong(place, "the check ends before it starts");
  check.first = *first;
  check.last = *last;
  return ok();
}

}  // namespace fieldproof::user_frames
