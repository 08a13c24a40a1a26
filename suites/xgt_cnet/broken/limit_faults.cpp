// Faults in what is accepted: ranges, counts, lengths, forms (Cnet EN 7.1.4, 7.1.5, Appendix 3.1).
#include <algorithm>
#include <cctype>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

using xgt_cnet::XgtRequest;
using xgt_cnet::XgtService;

namespace {

/// Asks again with other names what was refused with `code`.
MakeBehaviour forgive_name(unsigned code,
                           std::string (*rename)(const std::string& name, const GoodPlc& plc)) {
  return answer_with([code, rename](const Bytes& request, GoodPlc& plc) {
    const Bytes reply = plc.answer(request);
    if (refusal(reply) != code) return reply;
    const Bytes other =
        with_names(request, [&](const std::string& name) { return rename(name, plc); });
    return other == request ? reply : plc.answer(other);
  });
}

std::uint32_t elements_of(const std::string& name, const GoodPlc& plc) {
  const plc::DeviceArea* area = name.size() > 2 ? plc.model().area(name[1]) : nullptr;
  return area ? plc::element_count(*area, name[2]) : 0;
}

std::string last_for_one_past(const std::string& name, const GoodPlc& plc) {
  const NameParts parts = split_name(name);
  const bool one_past = parts.number && name[2] != 'X' && *parts.number == elements_of(name, plc);
  return one_past ? parts.area_and_type + std::to_string(*parts.number - 1) : name;
}

std::string wrapped(const std::string& name, const GoodPlc& plc) {
  const NameParts parts = split_name(name);
  const std::uint32_t size = elements_of(name, plc);
  return parts.number && size > 0 ? parts.area_and_type + std::to_string(*parts.number % size)
                                  : name;
}

/// Refuses the last element of each area.
Bytes refuse_last(const Bytes& frame, GoodPlc& plc) {
  const XgtRequest request = xgt_cnet::parse_request(frame);
  const Bytes reply = plc.answer(frame);
  if (reply.empty() || request.fault) return reply;
  const bool run =
      request.content == XgtService::read_run || request.content == XgtService::write_run;
  for (unsigned i = 0; i < request.blocks; ++i) {
    const plc::ParsedAddress parsed = plc.address(request.block[i].name);
    if (parsed && !plc::fits(plc.model(), parsed.address, (run ? request.count : 1) + 1))
      return nak_to(request, xgt_cnet::xgt_error::range);
  }
  return reply;
}

/// Refuses where `refuses` says so.
MakeBehaviour refuse(std::uint16_t code, bool (*refuses)(const XgtRequest& request)) {
  return answer_with([code, refuses](const Bytes& frame, GoodPlc& plc) {
    const XgtRequest request = xgt_cnet::parse_request(frame);
    const Bytes reply = plc.answer(frame);
    return !reply.empty() && refuses(request) ? nak_to(request, code) : reply;
  });
}

bool any_name(const XgtRequest& request, bool (*test)(std::string_view name)) {
  return std::any_of(request.block.begin(), request.block.begin() + request.blocks,
                     [test](const xgt_cnet::XgtBlock& block) { return test(block.name); });
}

/// What was refused with `code`, cut or changed in its body and asked again.
MakeBehaviour forgive(unsigned code, bool (*change)(FrameText& request)) {
  return answer_with([code, change](const Bytes& request, GoodPlc& plc) {
    const Bytes reply = plc.answer(request);
    FrameText text = take_apart(request);
    if (refusal(reply) != code || !change(text)) return reply;
    text.seal();
    return plc.answer(text.bytes());
  });
}

/// A name of 17 characters loses its first zero.
bool shorten_name(FrameText& text) {
  const std::size_t length = text.service()[2] == 'B' ? 5 : 7;
  if (text.body.size() < length + 6 || text.body.substr(length, 2) != "11" ||
      text.body[length + 5] != '0')
    return false;
  text.body.erase(length + 5, 1);
  text.body.replace(length, 2, "10");
  return true;
}

bool drop_surplus(FrameText& text) {
  const auto has_surplus = [&text] {
    text.seal();
    return xgt_cnet::parse_request(text.bytes()).fault.check == xgt_cnet::XgtCheck::surplus;
  };
  if (!has_surplus()) return false;
  while (has_surplus()) text.body.pop_back();
  return true;
}

/// A bit value above 01 becomes 01.
bool take_any_bit(FrameText& text) {
  text.body.replace(text.body.size() - 2, 2, "01");
  return true;
}

bool zero_for_not_hex(FrameText& text) {
  bool changed = false;
  for (std::size_t i = text.body.rfind('W') + 4; i < text.body.size(); ++i) {
    changed |= hex_digit(text.body[i]) < 0;
    if (hex_digit(text.body[i]) < 0) text.body[i] = '0';
  }
  return changed;
}

/// Joins the data of two acknowledgements of reads.
std::string joined_blocks(const Bytes& first, const Bytes& second) {
  const std::string a = take_apart(first).content(), b = take_apart(second).content();
  if (refusal(first) || refusal(second) || a.size() < 2 || b.size() < 2) return {};
  const auto count = static_cast<unsigned>(xgt_cnet::hex_value(a.substr(0, 2)) +
                                           xgt_cnet::hex_value(b.substr(0, 2)));
  return hex_number(count, 2) + a.substr(2) + b.substr(2);
}

/// Where block `count` of a list of names begins.
std::size_t behind_names(const std::string& content, unsigned count) {
  std::size_t at = 2;
  for (unsigned i = 0; i < count && at + 2 <= content.size(); ++i) {
    const std::int64_t length = xgt_cnet::hex_value(content.substr(at, 2));
    if (length < 0) return content.size();
    at += 2 + static_cast<std::size_t>(length);
  }
  return std::min(at, content.size());
}

Bytes read_seventeen(const Bytes& request, GoodPlc& plc) {
  const Bytes reply = plc.answer(request);
  const FrameText text = take_apart(request);
  if (refusal(reply) != xgt_cnet::xgt_error::blocks || text.service() != "RSS" ||
      !text.content().starts_with("11"))
    return reply;
  const std::size_t cut = behind_names(text.content(), xgt_cnet::xgt_max_blocks);
  FrameText first = text, rest = text;
  first.body = text.front() + "10" + text.content().substr(2, cut - 2);
  rest.body = text.front() + "01" + text.content().substr(cut);
  first.seal();
  rest.seal();
  const std::string content = joined_blocks(plc.answer(first.bytes()), plc.answer(rest.bytes()));
  return content.empty() ? reply : ack_to(xgt_cnet::parse_request(request), content);
}

Bytes read_sixty_one(const Bytes& request, GoodPlc& plc) {
  const Bytes reply = plc.answer(request);
  const FrameText text = take_apart(request);
  if (refusal(reply) != xgt_cnet::xgt_error::size || text.service() != "RSB") return reply;
  const XgtRequest parsed = xgt_cnet::parse_request(request);
  const NameParts name = split_name(parsed.block[0].name);
  if (parsed.count != 61 || !name.number) return reply;
  const auto part = [&](std::uint32_t first, std::string_view count) {
    FrameText one = text;
    const std::string from = name.area_and_type + std::to_string(first);
    one.body = text.front() + hex_number(from.size(), 2) + from + std::string(count);
    one.seal();
    return take_apart(plc.answer(one.bytes())).content();
  };
  const std::string all = part(*name.number, "3C"), last = part(*name.number + 60, "01");
  return all.size() < 4 || last.size() < 4
             ? reply
             : ack_to(parsed, "017A" + all.substr(4) + last.substr(4));
}

/// Mixed types are answered block by block.
Bytes read_mixed_types(const Bytes& request, GoodPlc& plc) {
  const Bytes reply = plc.answer(request);
  const XgtRequest parsed = xgt_cnet::parse_request(request);
  if (refusal(reply) != xgt_cnet::xgt_error::mixed_types ||
      parsed.service != XgtService::read_blocks)
    return reply;
  std::string content = hex_number(parsed.blocks, 2);
  for (unsigned i = 0; i < parsed.blocks; ++i) {
    XgtRequest one = parsed;
    one.fault = {};
    one.blocks = 1;
    one.block[0] = parsed.block[i];
    Bytes single;
    xgt_cnet::encode_request(one, single);
    const Bytes answer = plc.answer(single);
    if (refusal(answer)) return answer;
    content += take_apart(answer).content().substr(2);
  }
  return ack_to(parsed, content);
}

Bytes refuse_unknown_command(const Bytes& request, GoodPlc& plc) {
  const XgtRequest parsed = xgt_cnet::parse_request(request);
  if (parsed.fault.check != xgt_cnet::XgtCheck::command || parsed.station != plc.station())
    return plc.answer(request);
  return nak_to(parsed, xgt_cnet::xgt_error::data);
}

/// Only names as the manual prints them: `%`, capital letters, digits.
bool has_small_letter(std::string_view name) {
  return std::ranges::any_of(name, [](unsigned char c) { return std::islower(c); });
}

}  // namespace

std::vector<Fault> limit_faults() {
  return {
      {"one_past_the_end_accepted", "the address behind the last of an area is taken for the last",
       forgive_name(xgt_cnet::xgt_error::range, last_for_one_past),
       "areas/read_word_limits/xbc_h_m", "header"},
      {"last_address_refused", "the last address of an area is refused", answer_with(refuse_last),
       "areas/read_word_limits/xbc_h_m", "header"},
      {"addresses_wrap", "an address past the end begins again at 0",
       forgive_name(xgt_cnet::xgt_error::range, wrapped), "wss/example_nak/lower", "header"},
      {"run_may_leave_the_area", "RSB looks at its first address alone, and reads 0 behind the end",
       answer_with([](const Bytes& request, GoodPlc& plc) {
         const Bytes reply = plc.answer(request);
         const XgtRequest parsed = xgt_cnet::parse_request(request);
         const bool first_is_right = parsed.blocks == 1 && plc.address(parsed.block[0].name);
         if (refusal(reply) != xgt_cnet::xgt_error::range ||
             parsed.service != XgtService::read_run || !first_is_right)
           return reply;
         const unsigned bytes = parsed.count * plc::type_bytes(parsed.block[0].name[2]);
         return ack_to(parsed,
                       "01" + hex_number(bytes, 2) + std::string(std::size_t{bytes} * 2, '0'));
       }),
       "areas/continuous_read_across_the_end/xbc_h_m", "header"},
      {"seventeen_blocks_accepted", "RSS of 17 blocks is answered", answer_with(read_seventeen),
       "rss/seventeen_blocks/lower", "header"},
      {"sixteen_blocks_refused", "16 blocks are one too many",
       refuse(xgt_cnet::xgt_error::blocks, [](const XgtRequest& r) { return r.blocks == 16; }),
       "rss/block_counts/10", "header"},
      {"block_count_in_decimal", "the block count is decimal: 10 is ten blocks",
       misread([](const Bytes& request, GoodPlc&) {
         FrameText text = take_apart(request);
         if (text.service() != "RSS" || text.content().substr(0, 2) != "10") return request;
         text.body =
             text.front() + "0A" + text.content().substr(2, behind_names(text.content(), 10) - 2);
         text.seal();
         return text.bytes();
       }),
       "rss/block_counts/10", "block count"},
      {"sixty_one_words_accepted", "RSB of 61 words is answered", answer_with(read_sixty_one),
       "rsb/sixty_one_words/lower", "header"},
      {"sixty_words_refused", "60 words are one too many",
       refuse(
           xgt_cnet::xgt_error::size,
           [](const XgtRequest& r) { return r.count == 60 && r.content == XgtService::read_run; }),
       "rsb/sixty_words/lower", "header"},
      {"seventeen_characters_accepted", "a name of 17 characters is taken",
       forgive(xgt_cnet::xgt_error::name_length, shorten_name), "rss/seventeen_characters/lower",
       "header"},
      {"sixteen_characters_refused", "a name of 16 characters is too long",
       refuse(xgt_cnet::xgt_error::name_length,
              [](const XgtRequest& r) {
                return any_name(r, [](std::string_view name) { return name.size() == 16; });
              }),
       "rss/sixteen_characters/lower", "header"},
      {"leading_zeros_refused", "a number with leading zeros is refused",
       refuse(xgt_cnet::xgt_error::data,
              [](const XgtRequest& r) {
                return any_name(r, [](std::string_view n) {
                  return n.size() > 4 && n[2] != 'X' && n[3] == '0';
                });
              }),
       "rss/name_lengths/05", "header"},
      {"small_letters_refused", "device names in lower case are refused",
       refuse(xgt_cnet::xgt_error::data,
              [](const XgtRequest& r) { return any_name(r, has_small_letter); }),
       "commands/name_in_lower_case/lower/lower", "header"},
      {"small_digits_refused", "data with lower-case hex digits are refused",
       refuse(xgt_cnet::xgt_error::not_hex,
              [](const XgtRequest& r) {
                return std::any_of(
                    r.block.begin(), r.block.begin() + r.blocks,
                    [](const xgt_cnet::XgtBlock& b) { return has_small_letter(b.data); });
              }),
       "wss/data_lower_case_hex/lower", "header"},
      {"small_type_refused", "a command type in lower case is not answered",
       answer_with([](const Bytes& request, GoodPlc& plc) {
         const std::string front = take_apart(request).front();
         const bool small = front.size() > 3 && has_small_letter(front.substr(3));
         return small ? Bytes{} : plc.answer(request);
       }),
       "commands/type_in_lower_case/lower/ss", "no answer",
       "xgt_cnet/commands/type_in_lower_case/*/ss"},
      {"mixed_types_accepted", "blocks of different types are read", answer_with(read_mixed_types),
       "errors/printed_1332", "header"},
      {"surplus_ignored", "what follows the last field is not looked at",
       forgive(xgt_cnet::xgt_error::surplus, drop_surplus), "errors/printed_1234", "header"},
      {"any_bit_value_accepted", "a bit may be written as 11",
       forgive(xgt_cnet::xgt_error::data, take_any_bit), "errors/printed_0011_bit", "header"},
      {"not_hex_is_zero", "data that are not hex are taken for 0",
       forgive(xgt_cnet::xgt_error::not_hex, zero_for_not_hex), "errors/printed_1432", "header"},
      {"count_zero_accepted", "RSB of 00 is acknowledged with no data",
       answer_with([](const Bytes& request, GoodPlc& plc) {
         const XgtRequest parsed = xgt_cnet::parse_request(request);
         return parsed.service == XgtService::read_run &&
                        parsed.fault.check == xgt_cnet::XgtCheck::count && parsed.count == 0
                    ? ack_to(parsed, "0100")
                    : plc.answer(request);
       }),
       "rsb/count_00/lower/word", "header"},
      {"unknown_command_refused", "an unknown command draws NAK 0011",
       answer_with(refuse_unknown_command), "commands/unknown_command/a", "silence"},
  };
}

}  // namespace fieldproof::xgt_cnet_broken
