// Faults of requests, replies and error frames (FEnet EN 5.3.4, 5.3.5).
#include <algorithm>

#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

constexpr std::size_t byte_count_at = 8, data_at = 9;  // of the reply to a read

bool is_read(const Bytes& frame) { return function_of(frame) >= 1 && function_of(frame) <= 4; }
bool reads_words(const Bytes& frame) { return function_of(frame) == 3 || function_of(frame) == 4; }
bool reads_bits(const Bytes& frame) { return function_of(frame) == 1 || function_of(frame) == 2; }

/// Requests of these functions beyond `most` are refused like those of none.
MakeBehaviour limited(bool (*concerns)(const Bytes& frame), unsigned most) {
  return misreads([=](Bytes request) {
    if (concerns(request) && word_at(request, count_at) > most) put_word(request, count_at, 0);
    return request;
  });
}

MakeBehaviour edits_reads(std::function<void(Bytes& reply, const Bytes& request)> edit) {
  return edits([=](Bytes& reply, const Bytes& request) {
    if (!is_exception(reply) && is_read(request)) edit(reply, request);
  });
}

/// Another function is carried out; the reply names the one that was asked.
MakeBehaviour taken_for(Byte asked, Byte done) {
  return [=] {
    return Behaviour{.misread =
                         [=](Bytes request) {
                           if (function_of(request) == asked) request[function_at] = done;
                           return request;
                         },
                     .edit =
                         [=](Bytes& reply, const Bytes& request) {
                           if (function_of(request) != asked) return;
                           reply[function_at] =
                               static_cast<Byte>(asked | (reply[function_at] & 0x80));
                         }};
  };
}

MakeBehaviour edits_exceptions(std::function<void(Bytes& reply)> edit) {
  return edits([=](Bytes& reply, const Bytes&) {
    if (is_exception(reply)) edit(reply);
  });
}

Byte reversed(Byte b) {
  Byte result = 0;
  for (int i = 0; i < 8; ++i)
    if (b >> i & 1) result |= static_cast<Byte>(0x80 >> i);
  return result;
}

MakeBehaviour coil_value(std::function<unsigned(unsigned value)> take) {
  return [=] {
    return Behaviour{.misread =
                         [=](Bytes request) {
                           if (function_of(request) == 5 && request.size() == 12)
                             put_word(request, count_at, take(word_at(request, count_at)));
                           return request;
                         },
                     .edit =
                         [](Bytes& reply, const Bytes& request) {
                           if (function_of(request) == 5 && !is_exception(reply)) reply = request;
                         }};
  };
}

}  // namespace

std::vector<Fault> data_faults() {
  return {
      {"error_bit_missing", "error frames have the function code of the request",
       edits_exceptions([](Bytes& reply) { reply[function_at] &= 0x7F; }),
       "modbus_tcp/examples/read_coils_error/address", "function code"},
      {"error_code_missing", "error frames end behind the function code",
       edits_exceptions([](Bytes& reply) {
         reply.pop_back();
         set_length(reply);
       }),
       "modbus_tcp/examples/read_holding_registers_error/value", "length"},
      {"address_error_is_value_error", "a bad address draws exception 03",
       edits_exceptions([](Bytes& reply) {
         if (reply.back() == 2) reply.back() = 3;
       }),
       "modbus_tcp/examples/write_single_register_error/address", "exception code"},
      {"value_error_is_address_error", "a bad value draws exception 02",
       edits_exceptions([](Bytes& reply) {
         if (reply.back() == 3) reply.back() = 2;
       }),
       "modbus_tcp/examples/write_multiple_registers_error/value", "exception code"},
      {"unknown_function_is_address_error", "an unknown function draws exception 02",
       edits_exceptions([](Bytes& reply) {
         if (reply.back() == 1) reply.back() = 2;
       }),
       "modbus_tcp/exceptions/tcp_function/f07", "exception code"},
      {"unknown_function_ignored", "an unknown function is not answered",
       misreads([](Bytes request) { return function_of(request) > 0x10 ? Bytes{} : request; }),
       "modbus_tcp/exceptions/tcp_function/f41", "no answer"},
      {"bad_requests_ignored", "a request that is refused is not answered",
       acts([](Bursts& does, Server&) {
         std::erase_if(does, [](const Burst& one) { return is_exception(one.bytes); });
       }),
       "modbus_tcp/exceptions/last_address/f03", "no answer"},
      {"words_up_to_99", "100 words are refused", limited(reads_words, 99),
       "modbus_tcp/limits/holding_100", "function code"},
      {"one_word_alone", "more than one word is refused", limited(reads_words, 1),
       "modbus_tcp/limits/input_2", "function code"},
      {"bits_up_to_1599", "1600 bits are refused", limited(reads_bits, 1599),
       "modbus_tcp/limits/coils_1600", "function code"},
      {"no_words_are_one", "a request of no words is one of one word", misreads([](Bytes request) {
         if (reads_words(request) && word_at(request, count_at) == 0)
           put_word(request, count_at, 1);
         return request;
       }),
       "modbus_tcp/limits/holding_refused/c0000", "function code"},
      {"no_bits_are_none", "a request of no bits is answered with none",
       edits([](Bytes& reply, const Bytes& request) {
         if (!reads_bits(request) || word_at(request, count_at) != 0) return;
         reply.resize(function_at);
         reply.insert(reply.end(), {function_of(request), 0});
         set_length(reply);
       }),
       "modbus_tcp/limits/inputs_refused/c0000", "function code"},
      {"count_of_one_byte", "the high byte of the count is not looked at",
       misreads([](Bytes request) {
         if (is_read(request)) request[count_at] = 0;
         return request;
       }),
       "modbus_tcp/limits/holding_refused/c0101", "function code"},
      {"bits_in_reverse", "the first bit is the highest of its byte",
       edits_reads([](Bytes& reply, const Bytes& request) {
         for (std::size_t i = data_at; reads_bits(request) && i < reply.size(); ++i)
           reply[i] = reversed(reply[i]);
       }),
       "modbus_tcp/examples/read_coils", "data"},
      {"unused_bits_set", "the unused bits of the last byte are on",
       edits_reads([](Bytes& reply, const Bytes& request) {
         if (const unsigned used = word_at(request, count_at) % 8; reads_bits(request) && used)
           reply.back() |= static_cast<Byte>(0xFF << used);
       }),
       "modbus_tcp/examples/read_coils", "data"},
      {"a_byte_too_many_bits", "bits come with one byte more",
       edits_reads([](Bytes& reply, const Bytes& request) {
         if (!reads_bits(request) || word_at(request, count_at) % 8) return;
         reply.push_back(0);
         ++reply[byte_count_at];
         set_length(reply);
       }),
       "modbus_tcp/limits/coils_8", "length"},
      {"byte_count_in_words", "the byte count of a reply is that of words",
       edits_reads([](Bytes& reply, const Bytes& request) {
         if (reads_words(request)) reply[byte_count_at] /= 2;
       }),
       "modbus_tcp/examples/read_holding_registers", "byte count"},
      {"byte_count_of_two_bytes", "the byte count of a reply has two bytes",
       edits_reads([](Bytes& reply, const Bytes&) {
         reply.insert(reply.begin() + byte_count_at, 0);
         set_length(reply);
       }),
       "modbus_tcp/examples/read_input_registers", "length"},
      {"words_low_byte_first", "words have their low byte first",
       edits_reads([](Bytes& reply, const Bytes& request) {
         for (std::size_t i = data_at; reads_words(request) && i + 1 < reply.size(); i += 2)
           std::swap(reply[i], reply[i + 1]);
       }),
       "modbus_tcp/examples/read_holding_registers", "data"},
      {"address_off_by_one", "data address 1 is the first", misreads([](Bytes request) {
         if (is_read(request)) put_word(request, address_at, word_at(request, address_at) - 1);
         return request;
       }),
       "modbus_tcp/examples/read_holding_registers", "data"},
      {"input_words_from_the_outputs", "FC 04 reads what FC 03 reads", taken_for(4, 3),
       "modbus_tcp/bases/tcp_four", "data"},
      {"inputs_from_the_coils", "FC 02 reads what FC 01 reads", taken_for(2, 1),
       "modbus_tcp/bases/tcp_four", "data"},
      {"any_value_is_on", "FC 05 takes any value but 0000 for on",
       coil_value([](unsigned value) { return value ? 0xFF00u : 0u; }),
       "modbus_tcp/examples/fc05_as_printed/table_5_31", "the request came back"},
      {"off_is_on", "FC 05 switches on, whatever its value",
       coil_value([](unsigned) { return 0xFF00u; }), "modbus_tcp/data/tcp_bit_in_word/b0_off", ""},
      {"word_echo_of_zeros", "the reply to FC 06 has value 0",
       edits([](Bytes& reply, const Bytes& request) {
         if (function_of(request) == 6 && !is_exception(reply)) put_word(reply, count_at, 0);
       }),
       "modbus_tcp/examples/write_single_register", "value"},
      {"words_echoed_as_bytes", "the reply to FC 10 counts bytes",
       edits([](Bytes& reply, const Bytes& request) {
         if (function_of(request) == 0x10 && !is_exception(reply))
           put_word(reply, count_at, 2 * word_at(reply, count_at));
       }),
       "modbus_tcp/examples/write_multiple_registers", "count"},
      {"whole_write_echoed", "the reply to FC 0F is the request",
       edits([](Bytes& reply, const Bytes& request) {
         if (function_of(request) == 0x0F && !is_exception(reply)) reply = request;
       }),
       "modbus_tcp/examples/write_multiple_coils", ""},
      {"byte_count_not_checked", "the byte count of FC 10 is not looked at",
       misreads([](Bytes request) {
         constexpr std::size_t byte_count = 12, head = 13;
         const std::size_t bytes = 2 * word_at(request, count_at);
         if (function_of(request) != 0x10 || request.size() < head || bytes == 0 || bytes > 246)
           return request;
         request[byte_count] = static_cast<Byte>(bytes);
         request.resize(head + bytes);
         set_length(request);
         return request;
       }),
       "modbus_tcp/mbap/length_surplus/n254_words", "function code"},
      {"stop_refuses_writes", "writes are lost, though acknowledged",
       [] {
         return Behaviour{.misread =
                              [](Bytes request) {
                                if (function_of(request) == 6) {
                                  request[function_at] = 3;
                                  put_word(request, count_at, 1);
                                }
                                return request;
                              },
                          .edit =
                              [](Bytes& reply, const Bytes& request) {
                                if (function_of(request) == 6) reply = request;
                              }};
       },
       "modbus_tcp/data/tcp_fc06_read_each_way", "data"},
  };
}

}  // namespace fieldproof::modbus_tcp_broken
