// Faults in the form of replies (Cnet EN 7.1.2, 7.1.5).
#include <algorithm>
#include <cctype>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

namespace {

/// Edits the acknowledgement of one service.
MakeBehaviour edit_ack(std::string_view service, void (*edit)(FrameText& reply)) {
  return edit_reply([service, edit](FrameText& reply, const FrameText& request) {
    if (reply.is_ack() && request.service().starts_with(service)) edit(reply);
  });
}

MakeBehaviour edit_nak(void (*edit)(FrameText& reply)) {
  return edit_reply([edit](FrameText& reply, const FrameText&) {
    if (reply.is_nak()) edit(reply);
  });
}

MakeBehaviour other_code(std::string_view right, std::string_view wrong) {
  return edit_reply([right, wrong](FrameText& reply, const FrameText&) {
    if (reply.is_nak() && reply.content() == right) reply.body = reply.front() + std::string(wrong);
  });
}

std::string plus_one(std::string_view digits) {
  return hex_number(static_cast<std::uint64_t>(xgt_cnet::hex_value(digits)) + 1, 2);
}

/// Replaces the number of data of each block of RSS and RSB.
void recount(FrameText& reply, unsigned (*count)(unsigned bytes)) {
  std::size_t at = 7;
  while (at + 2 <= reply.body.size()) {
    const auto bytes = static_cast<unsigned>(xgt_cnet::hex_value(reply.body.substr(at, 2)));
    reply.body.replace(at, 2, hex_number(count(bytes), 2));
    at += 2 + 2 * std::size_t{bytes};
  }
}

void reverse_blocks(FrameText& reply) {
  const Bytes bytes = reply.bytes();
  const xgt_cnet::XgtReply parsed = xgt_cnet::parse_reply(bytes);
  std::string content = hex_number(parsed.blocks, 2);
  for (unsigned i = parsed.blocks; i-- > 0;)
    content += hex_number(parsed.data[i].size() / 2, 2) + std::string(parsed.data[i]);
  reply.body = reply.front() + content;
}

void toggle_case(FrameText& reply) {
  const auto command = static_cast<unsigned char>(reply.command());
  reply.body[2] =
      static_cast<char>(reply.lower_case() ? std::toupper(command) : std::tolower(command));
  reply.check = reply.lower_case() ? sum_of(reply.without_check()) : "";
}

/// The data of the request come back behind the command.
void return_data(FrameText& reply, const FrameText& request) {
  if (reply.is_ack() && request.service()[0] == 'W') reply.body += request.content().substr(0, 2);
}

}  // namespace

std::vector<Fault> reply_faults() {
  return {
      {"reply_in_other_case",
       "replies have the command in the other case, with the BCC that goes with it",
       spoil_frame([](FrameText& r, const FrameText&) { toggle_case(r); }),
       "commands/main_command_case_in_reply/r", "command"},
      {"reply_always_in_upper_case", "replies have the command in upper case and no BCC",
       spoil_frame([](FrameText& r, const FrameText&) {
         if (r.lower_case()) toggle_case(r);
       }),
       "commands/main_command_case_in_reply/r", "command"},
      {"ack_for_nak", "a refusal begins with ACK", edit_nak([](FrameText& r) { r.head = '\x06'; }),
       "frame_structure/nak/lower", "head"},
      {"enq_for_ack", "an acknowledgement begins with ENQ",
       edit_ack("", [](FrameText& r) { r.head = '\x05'; }), "areas/read_word_limits/xbc_h_m",
       "header", broken::alone},
      {"eot_for_etx", "replies end with EOT",
       edit_reply([](FrameText& r, const FrameText&) { r.tail = '\x04'; }),
       "errors/code_is_four_characters/lower", "tail"},
      {"no_tail", "replies have no ETX", answer_with([](const Bytes& request, GoodPlc& plc) {
         Bytes reply = plc.answer(request);
         std::erase(reply, xgt_cnet::xgt_etx);
         return reply;
       }),
       "errors/code_is_four_characters/lower", "tail"},
      {"nak_in_three_digits", "the error code has three digits",
       edit_nak([](FrameText& r) { r.body.erase(5, 1); }), "errors/code_is_four_characters/lower",
       "error code"},
      {"nak_without_code", "a refusal has no error code",
       edit_nak([](FrameText& r) { r.body = r.front(); }), "errors/code_is_four_characters/lower",
       "error code"},
      {"nak_of_rss", "every refusal says that it answers SS", edit_nak([](FrameText& r) {
         if ((r.command() | 0x20) == 'r') r.body.replace(3, 2, "SS");
       }),
       "rsb/refused/lower", "command"},
      {"nak_code_low_byte_first", "the error code has its low byte first",
       edit_nak([](FrameText& r) {
         r.body = r.front() + r.content().substr(2) + r.content().substr(0, 2);
       }),
       "errors/code_is_four_characters/lower", "error code"},
      {"0011_for_1132", "a wrong area is refused with 0011", other_code("1132", "0011"),
       "errors/code_is_four_characters/lower", "error code"},
      {"0007_for_1332", "mixed types are refused with 0007", other_code("1332", "0007"),
       "errors/printed_1332", "error code"},
      {"0190_for_0090", "a number that is not registered is refused with 0190",
       other_code("0090", "0190"), "errors/code_0090/lower", "error code"},
      {"1132_for_7132", "an address past the end is refused with 1132", other_code("7132", "1132"),
       "errors/printed_7132", "error code"},
      {"0011_for_1432", "data that are not hex are refused with 0011", other_code("1432", "0011"),
       "errors/printed_1432", "error code"},
      {"silent_where_nak_is_due", "a refusal is not sent",
       spoil_frame([](FrameText& r, const FrameText&) {
         if (r.is_nak()) r = {};
       }),
       "errors/code_is_four_characters/lower", "no answer"},
      {"rsb_without_block_count", "the reply to RSB has no block count",
       edit_ack("RSB", [](FrameText& r) { r.body.erase(5, 2); }),
       "rsb/reply_has_a_block_count/lower/word", "block count"},
      {"rss_without_block_count", "the reply to RSS has no block count",
       edit_ack("RSS", [](FrameText& r) { r.body.erase(5, 2); }), "rss/data_of_four_bytes/lower",
       "block count"},
      {"block_count_one_more", "the block count of replies to RSS is one too high",
       edit_ack("RSS",
                [](FrameText& r) { r.body.replace(5, 2, plus_one(r.content().substr(0, 2))); }),
       "rss/two_words/lower", "block count"},
      {"block_count_always_01", "the block count of replies to RSS is always 01",
       edit_ack("RSS", [](FrameText& r) { r.body.replace(5, 2, "01"); }), "rss/two_words/lower",
       "block count"},
      {"number_of_data_in_words", "the number of data of replies counts words",
       edit_ack("R",
                [](FrameText& r) { recount(r, [](unsigned bytes) { return (bytes + 1) / 2; }); }),
       "rss/two_words/lower", "number of data"},
      {"number_of_data_in_digits", "the number of data of replies counts digits",
       edit_ack("RSB", [](FrameText& r) { recount(r, [](unsigned bytes) { return bytes * 2; }); }),
       "rsb/two_words/lower", "number of data"},
      {"write_ack_with_data", "the acknowledgement of a write carries the block count",
       edit_reply(return_data), "wss/ack_has_no_data/lower", "surplus"},
      {"null_code_in_write_ack", "the 'Null code' of a write acknowledgement is sent as a byte",
       edit_ack("W", [](FrameText& r) { r.body += '\0'; }),
       "frame_structure/write_ack_has_no_data_ss/lower", "surplus"},
      {"data_in_lower_case", "the data of replies have lower-case digits",
       edit_ack("R",
                [](FrameText& r) {
                  std::transform(r.body.begin() + 5, r.body.end(), r.body.begin() + 5,
                                 [](unsigned char c) { return std::tolower(c); });
                }),
       "frame_structure/data_in_lower_case_digits", "data"},
      {"blocks_in_reverse", "the blocks of replies to RSS come in reverse order",
       edit_ack("RSS", reverse_blocks), "rss/order_and_repetition/lower", "data"},
      {"h_before_numbers", "numbers of replies have the manual's H in front",
       edit_ack("R", [](FrameText& r) { r.body.insert(5, "H"); }),
       "frame_structure/numbers_without_h/lower", "block count"},
      {"type_missing", "replies to writes have no command type",
       edit_ack("W", [](FrameText& r) { r.body.erase(3, 2); }),
       "frame_structure/write_ack_has_no_data_ss/lower", "command"},
  };
}

}  // namespace fieldproof::xgt_cnet_broken
