// Faults in the form of replies (Cnet EN 8.2).
#include <algorithm>
#include <cctype>

#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {

using Edit = void (*)(FrameText& reply, const FrameText& request);

/// Edits the acknowledgement of one command.
MakeBehaviour edit_ack(char command, Edit edit) {
  return edit_reply([=](FrameText& reply, const FrameText& request) {
    if (reply.is_ack() && reply.command() == command) edit(reply, request);
  });
}

MakeBehaviour edit_nak(Edit edit) {
  return edit_reply([=](FrameText& reply, const FrameText& request) {
    if (reply.is_nak()) edit(reply, request);
  });
}

MakeBehaviour other_code(std::string_view right, std::string_view wrong) {
  return edit_reply([=](FrameText& reply, const FrameText&) {
    if (reply.is_nak() && reply.content() == right) reply.set_content(wrong);
  });
}

/// The words of the content in another order, or with their bytes in another order.
void reverse_words(FrameText& reply, const FrameText&) {
  std::string reversed;
  for (std::string rest = reply.content(); !rest.empty(); rest.erase(0, 4))
    reversed.insert(0, rest, 0, 4);
  reply.set_content(reversed);
}

void swap_bytes(FrameText& reply, const FrameText&) {
  std::string swapped;
  for (std::string rest = reply.content(); rest.size() >= 4; rest.erase(0, 4))
    swapped += rest.substr(2, 2) + rest.substr(0, 2);
  reply.set_content(swapped);
}

}  // namespace

std::vector<Fault> reply_faults() {
  return {
      {"ack_without_station", "an acknowledgement of R has no station",
       edit_ack('R', [](FrameText& r, const FrameText&) { r.body.erase(0, 2); }), "read/example",
       "station"},
      {"ack_without_command", "an acknowledgement of R has no command",
       edit_ack('R', [](FrameText& r, const FrameText&) { r.body.erase(2, 1); }), "read/example",
       "command"},
      {"command_in_lower_case", "replies have the command in lower case",
       edit_reply([](FrameText& r, const FrameText&) {
         r.body[2] = static_cast<char>(std::tolower(r.body[2]));
       }),
       "read/example", "command"},
      {"read_acknowledged_as_w", "an acknowledgement of R says W",
       edit_ack('R', [](FrameText& r, const FrameText&) { r.body[2] = 'W'; }), "read/example",
       "command"},
      {"ack_for_nak", "a refusal begins with ACK",
       edit_nak([](FrameText& r, const FrameText&) { r.head = '\x06'; }),
       "frame_structure/control_codes_nak", "header"},
      {"enq_for_ack", "an acknowledgement of R begins with ENQ",
       edit_ack('R', [](FrameText& r, const FrameText&) { r.head = '\x05'; }),
       "frame_structure/control_codes", "header"},
      {"etx_for_eot", "replies end with ETX",
       edit_reply([](FrameText& r, const FrameText&) { r.tail = '\x03'; }), "read/example", "tail"},
      {"no_eot", "replies have no EOT",
       edit_reply([](FrameText& r, const FrameText&) { r.tail.clear(); }), "read/example", "tail"},
      {"eot_twice", "replies end with two EOT",
       edit_reply([](FrameText& r, const FrameText&) { r.tail += '\x04'; }), "read/example",
       "after the complete"},
      {"cr_lf_for_eot", "replies end with CR LF",
       edit_reply([](FrameText& r, const FrameText&) { r.tail = "\r\n"; }), "read/example", "tail"},
      {"write_ack_without_data", "an acknowledgement of W has no data",
       edit_ack('W', [](FrameText& r, const FrameText&) { r.set_content(""); }),
       "write/example_address_first", "data"},
      {"write_ack_with_address", "an acknowledgement of W has the address before the data",
       edit_ack('W', [](FrameText& r, const FrameText& q) { r.body.insert(3, q.content(), 0, 4); }),
       "write/example_address_first", "data"},
      {"read_ack_with_address", "an acknowledgement of R has the address before the data",
       edit_ack('R', [](FrameText& r, const FrameText& q) { r.body.insert(3, q.content(), 0, 4); }),
       "read/example", "data"},
      {"read_ack_with_count", "an acknowledgement of R has the count before the data",
       edit_ack('R', [](FrameText& r, const FrameText& q) { r.body.insert(3, q.content(), 4, 1); }),
       "read/example", "data"},
      {"h_before_data", "data have the manual's H in front",
       edit_ack('R', [](FrameText& r, const FrameText&) { r.body.insert(3, "H"); }), "read/example",
       "data"},
      {"data_in_lower_case", "data of replies have lower-case digits",
       edit_ack('R',
                [](FrameText& r, const FrameText&) { r.set_content(in_lower_case(r.content())); }),
       "read/values/abcd", "data"},
      {"low_byte_first", "words are read with their low byte first", edit_ack('R', swap_bytes),
       "read/example", "data"},
      {"words_in_reverse", "words are read in reverse order", edit_ack('R', reverse_words),
       "read/count/words_2", "data"},
      {"first_word_alone", "a read of several words gives the first",
       edit_ack('R',
                [](FrameText& r, const FrameText&) { r.set_content(r.content().substr(0, 4)); }),
       "read/count/words_2", "data"},
      {"first_word_repeated", "a read of several words gives the first again and again",
       edit_ack('R',
                [](FrameText& r, const FrameText&) {
                  for (std::size_t at = 7; at + 4 <= r.body.size(); at += 4)
                    r.body.replace(at, 4, r.body, 3, 4);
                }),
       "read/count/words_2", "data"},
      {"one_word_too_many", "a read gives one word more",
       edit_ack('R', [](FrameText& r, const FrameText&) { r.body += "0000"; }), "read/example",
       "data"},
      {"no_leading_zeros", "data of replies have no leading zeros",
       edit_ack('R',
                [](FrameText& r, const FrameText&) {
                  const std::string digits = r.content();
                  r.set_content(
                      digits.substr(std::min(digits.find_first_not_of('0'), digits.size() - 1)));
                }),
       "read/values/0001", "data"},
      {"data_in_decimal", "data of replies are decimal",
       edit_ack('R',
                [](FrameText& r, const FrameText&) {
                  if (r.content().size() == 4)
                    r.set_content(std::to_string(std::stoul(r.content(), nullptr, 16)));
                }),
       "read/example", "data"},
      {"code_in_four_digits", "the error code has four characters",
       edit_nak([](FrameText& r, const FrameText&) { r.body.insert(3, "00"); }),
       "errors/format_of_the_nak_r", "error code"},
      {"code_in_lower_case", "the error code is in lower case",
       edit_nak([](FrameText& r, const FrameText&) { r.set_content(in_lower_case(r.content())); }),
       "errors/no_such_address_read/a1000", "error code"},
      {"code_reversed", "the characters of the error code change places",
       edit_nak([](FrameText& r, const FrameText&) { std::swap(r.body[3], r.body[4]); }),
       "errors/no_such_address_read/a1000", "error code"},
      {"nak_without_code", "a refusal has no error code",
       edit_nak([](FrameText& r, const FrameText&) { r.set_content(""); }),
       "errors/format_of_the_nak_r", "error code"},
      {"nak_without_command", "a refusal has no command",
       edit_nak([](FrameText& r, const FrameText&) { r.body.erase(2, 1); }),
       "errors/format_of_the_nak_r", "command"},
      {"printed_code", "every refusal has the code 12 of the manual's example",
       edit_nak([](FrameText& r, const FrameText&) { r.set_content("12"); }),
       "errors/no_such_address_read/a1000", "error code"},
      {"id_for_ia", "an unknown address is refused with ID", other_code("IA", "ID"),
       "errors/no_such_address_read/a1000", "error code"},
      {"ia_for_id", "a bad count is refused with IA", other_code("ID", "IA"), "errors/count_read/9",
       "error code"},
      {"fe_for_if", "an unknown function is refused with FE", other_code("IF", "FE"),
       "errors/function/upper_q", "error code"},
      {"id_for_fe", "a wrong sum is refused with ID", other_code("FE", "ID"), "errors/wrong_sum/r",
       "error code"},
      {"silent_where_nak_is_due", "a refusal is not sent",
       spoil_frame([](FrameText& r, const FrameText&) {
         if (r.is_nak()) r.head = 0;
       }),
       "errors/count_read/9", "no answer"},
  };
}

}  // namespace fieldproof::ls_bus_broken
