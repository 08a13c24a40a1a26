// Faults of refusals: their codes, their form, and what is refused at all (DECISIONS.md
// fenet/error-codes).
#include <algorithm>

#include "suites/xgt_fenet/broken/faults.hpp"

namespace fieldproof::xgt_fenet_broken {

namespace {

/// One code where another is right.
MakeBehaviour code(unsigned right, unsigned wrong) {
  return edits([=](Bytes& reply, const Bytes&) {
    if (is_refusal(reply) && word_at(reply, code_at) == right) put_word(reply, code_at, wrong);
  });
}

MakeBehaviour refusals(std::function<void(Bytes& reply)> change) {
  return edits([change](Bytes& reply, const Bytes&) {
    if (is_refusal(reply)) change(reply);
  });
}

}  // namespace

std::vector<Fault> code_faults() {
  return {
      {"code_of_blocks", "too many blocks give 0011", code(0x01, 0x11),
       "xgt_fenet/read/seventeen_blocks/word", ""},
      {"code_of_letter", "a wrong type letter gives 0024", code(0x02, 0x24),
       "xgt_fenet/names/unknown_letters/z", ""},
      {"code_of_area", "an unknown area gives 0004", code(0x03, 0x04),
       "xgt_fenet/names/unknown_areas/xbc_h_a", ""},
      {"code_of_range", "past the end gives 0003", code(0x04, 0x03),
       "xgt_fenet/errors/by_command/write_04", ""},
      {"code_of_size", "a wrong size gives 0011", code(0x05, 0x11),
       "xgt_fenet/write/size_of_another_type/word_1", ""},
      {"code_of_device", "a digit for an area gives 0011", code(0x10, 0x11),
       "xgt_fenet/names/no_area_letter/digit", ""},
      {"code_of_name", "a name without % gives 0010", code(0x11, 0x10),
       "xgt_fenet/names/without_percent/no_percent", ""},
      {"code_of_continuous", "words in a continuous request give 0002", code(0x12, 0x02),
       "xgt_fenet/continuous/other_types/read_w", ""},
      {"code_of_data_type", "an unknown data type gives 0002", code(0x24, 0x02),
       "xgt_fenet/errors/unknown_data_types/t0500/read", ""},
      {"code_of_id", "a wrong company id gives 0076", code(0x75, 0x76),
       "xgt_fenet/header/company_id_wrong/zeros", ""},
      {"code_of_length", "a body that is cut gives 0011", code(0x76, 0x11),
       "xgt_fenet/length/cut_read/at_9", ""},
      {"code_of_check", "a wrong check gives 0075", code(0x77, 0x75),
       "xgt_fenet/header/check_of_request/strict_wrong", ""},
      {"code_of_command", "an unknown command gives 0001", code(0x78, 0x01),
       "xgt_fenet/errors/unknown_commands/c0053", ""},
      {"code_swapped", "the bytes of the code change places",
       refusals([](Bytes& reply) { std::swap(reply[code_at], reply[code_at + 1]); }),
       "xgt_fenet/errors/form_of_a_refusal", ""},
      {"code_of_one_byte", "the code has one byte", refusals([](Bytes& reply) {
         reply.pop_back();
         put_word(reply, length_at, 9);
         mend(reply);
       }),
       "xgt_fenet/errors/form_of_a_refusal", ""},
      {"status_0001", "the status of a refusal is 0001",
       refusals([](Bytes& reply) { put_word(reply, status_at, 1); }),
       "xgt_fenet/errors/form_of_a_refusal", ""},
      {"status_is_the_code", "the code stands as status",
       refusals([](Bytes& reply) { put_word(reply, status_at, word_at(reply, code_at)); }),
       "xgt_fenet/errors/form_of_a_refusal", ""},
      {"refusal_of_the_request", "a refusal repeats the command of the request",
       refusals([](Bytes& reply) { --reply[command_at]; }), "xgt_fenet/errors/form_of_a_refusal",
       ""},
      {"refusal_without_type", "a refusal has data type 0000",
       refusals([](Bytes& reply) { put_word(reply, type_at, 0); }),
       "xgt_fenet/errors/by_command/write_04", ""},
      {"refusals_unanswered", "what cannot be served draws no answer",
       acts([](Bursts& does, Server&) {
         std::erase_if(does, [](const Burst& one) { return is_refusal(one.bytes); });
       }),
       "xgt_fenet/errors/form_of_a_refusal", "no answer"},
      {"refusal_ends_the_connection", "a refusal ends the connection",
       acts([](Bursts& does, Server&) {
         const std::size_t count = does.size();
         for (std::size_t i = 0; i < count; ++i)
           if (is_refusal(does[i].bytes))
             does.push_back(
                 {.bytes = {}, .start = {}, .link = does[i].link, .event = LinkEvent::reset});
       }),
       "xgt_fenet/errors/after_many", ""},
      {"commands_by_low_bits", "command 56 is taken for a read", misreads([](Bytes request) {
         if (word_at(request, command_at) == 0x56) put_word(request, command_at, 0x54);
         return request;
       }),
       "xgt_fenet/errors/unknown_commands/c0056", ""},
      {"replies_are_commands", "a reply is taken for a request", misreads([](Bytes request) {
         if (word_at(request, command_at) == 0x55) put_word(request, command_at, 0x54);
         return request;
       }),
       "xgt_fenet/errors/unknown_commands/c0055", ""},
      {"commands_of_one_byte", "the high byte of the command is not looked at",
       misreads([](Bytes request) {
         if (request.size() > command_at + 1) request[command_at + 1] = 0;
         return request;
       }),
       "xgt_fenet/errors/unknown_commands/c0154", ""},
      {"commands_swapped_too", "the command is taken high byte first, too",
       misreads([](Bytes request) {
         if (word_at(request, command_at) == 0x5400) put_word(request, command_at, 0x54);
         return request;
       }),
       "xgt_fenet/errors/unknown_commands/c5400", ""},
      {"types_of_one_byte", "the high byte of the data type is not looked at",
       misreads([](Bytes request) {
         if (request.size() > type_at + 1) request[type_at + 1] = 0;
         return request;
       }),
       "xgt_fenet/errors/unknown_data_types/t0201/read", ""},
  };
}

}  // namespace fieldproof::xgt_fenet_broken
