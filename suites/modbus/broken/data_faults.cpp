// Faults in what is read and written: addresses, order of bits and bytes, which area
// (Cnet EN 6.1.3, 9.3.2 (5), 9.4).
#include <algorithm>
#include <array>

#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

namespace {

/// Edits the data of replies to reads by one of two function codes.
MakeBehaviour edit_data(Byte one, Byte other,
                        std::function<void(Bytes& data, const Bytes& request)> edit) {
  return edit_reply([one, other, edit = std::move(edit)](Bytes& reply, const Bytes& request) {
    if (exception_of(reply) || (function_of(request) != one && function_of(request) != other))
      return;
    Bytes data = data_of_read(reply);
    edit(data, request);
    reply = read_reply(request, data);
  });
}

Byte mirrored(Byte value) {
  Byte result = 0;
  for (int bit = 0; bit < 8; ++bit)
    if (value & (1 << bit)) result |= static_cast<Byte>(0x80 >> bit);
  return result;
}

void swap_bytes(Bytes& data) {
  for (std::size_t i = 0; i + 1 < data.size(); i += 2) std::swap(data[i], data[i + 1]);
}

/// Another function code for reads: the other area.
MakeBehaviour reads_other_area(Byte one, Byte other) {
  return answer_with([one, other](const Bytes& request, GoodModbus& plc) {
    const Byte function = function_of(request);
    if (function != one && function != other) return plc.ask(request);
    Bytes misread = request;
    misread[1] = function == one ? other : one;
    Bytes reply = plc.ask(misread);
    if (reply.size() > 1) reply[1] = static_cast<Byte>(function | (reply[1] & 0x80));
    return reply;
  });
}

/// Words in requests to write come with the low byte first.
Bytes write_words_swapped(Bytes request) {
  const std::size_t from = function_of(request) == 0x06   ? 4
                           : function_of(request) == 0x10 ? 7
                                                          : request.size();
  for (std::size_t i = from; i + 1 < request.size(); i += 2) std::swap(request[i], request[i + 1]);
  return request;
}

/// Counts data addresses from 1; the reply to a write repeats what was asked.
Bytes one_based(const Bytes& request, GoodModbus& plc) {
  if (request.size() < 6 || word_at(request, address_at) == 0) return plc.ask(request);
  Bytes other = request;
  put_word(other, address_at, word_at(request, address_at) - 1);
  Bytes reply = plc.ask(other);
  if (!reply.empty() && !exception_of(reply) && !is_read(function_of(reply)))
    put_word(reply, address_at, word_at(request, address_at));
  return reply;
}

/// Writes what fits in before it refuses the rest.
Bytes write_partly(const Bytes& request, GoodModbus& plc) {
  const Bytes reply = plc.ask(request);
  if (exception_of(reply) != address_error || function_of(request) < 0x0F) return reply;
  const unsigned address = word_at(request, address_at), count = word_at(request, count_at);
  const Bytes data = data_of_write(request);
  for (unsigned i = 0; i < count; ++i) {
    Bytes one{request[0], 0x06, 0, 0, 0, 0};
    put_word(one, address_at, address + i);
    if (function_of(request) == 0x0F) {
      one[1] = 0x05;
      put_word(one, value_at, i / 8 < data.size() && (data[i / 8] >> (i % 8) & 1) ? 0xFF00 : 0);
    } else {
      put_word(one, value_at, word_at(data, std::size_t{i} * 2));
    }
    if (exception_of(plc.ask(one))) return reply;
  }
  return reply;
}

/// Cuts writes of many to the first `count` elements; the reply names them all.
MakeBehaviour write_first(Byte function, unsigned most) {
  return answer_with([function, most](const Bytes& request, GoodModbus& plc) {
    if (function_of(request) != function || word_at(request, count_at) <= most)
      return plc.ask(request);
    Bytes data = data_of_write(request);
    const std::size_t bytes = is_bits(function) ? (most + 7) / 8 : most * 2;
    if (data.size() <= bytes) return plc.ask(request);
    data.resize(bytes);
    Bytes reply = plc.ask(write_many(request, word_at(request, address_at), most, data));
    if (reply.size() == 6) put_word(reply, count_at, word_at(request, count_at));
    return reply;
  });
}

/// Writes whole bytes: what pads the last one is written, too.
Bytes write_padding(Bytes request) {
  if (function_of(request) != 0x0F || request.size() < 8) return request;
  put_word(request, count_at, request[6] * 8u);
  return request;
}

MakeBehaviour edit_write_reply(Byte function, void (*edit)(Bytes& reply, const Bytes& request)) {
  return edit_reply([function, edit](Bytes& reply, const Bytes& request) {
    if (function_of(reply) == function) edit(reply, request);
  });
}

/// A word that is written clears the next one.
Bytes clear_next(const Bytes& request, GoodModbus& plc) {
  const Bytes reply = plc.ask(request);
  if (function_of(reply) != 0x06 && function_of(reply) != 0x10) return reply;
  Bytes next{request[0], 0x06, 0, 0, 0, 0};
  put_word(
      next, address_at,
      word_at(request, address_at) + (function_of(reply) == 0x06 ? 1 : word_at(request, count_at)));
  (void)plc.ask(next);
  return reply;
}

}  // namespace

std::vector<Fault> data_faults() {
  return {
      {"byte_count_one_more", "the byte count of replies is one too high",
       edit_reply([](Bytes& reply, const Bytes& request) {
         if (is_read(function_of(reply)) && reply.size() > 2 && is_read(function_of(request)))
           ++reply[2];
       }),
       "modbus_rtu/modes/serves", "byte count"},
      {"byte_count_in_words", "the byte count of replies counts words",
       edit_reply([](Bytes& reply, const Bytes&) {
         if (function_of(reply) == 0x03 || function_of(reply) == 0x04) reply[2] /= 2;
       }),
       "modbus_rtu/modes/serves", "byte count"},
      {"bits_mirrored", "the first bit of a byte of coils or inputs is bit 7",
       edit_data(
           0x01, 0x02,
           [](Bytes& data, const Bytes&) { std::ranges::transform(data, data.begin(), mirrored); }),
       "modbus_rtu/data/bits_01/a3_n13", "data"},
      {"bits_in_reverse_bytes", "the bytes of coils come last first",
       edit_data(0x01, 0x02, [](Bytes& data, const Bytes&) { std::ranges::reverse(data); }),
       "modbus_rtu/data/bits_01/a0_n16", "data"},
      {"padding_is_ones", "what pads the last byte of coils is 1",
       edit_data(0x01, 0x02,
                 [](Bytes& data, const Bytes& request) {
                   if (const unsigned used = word_at(request, count_at) % 8; used != 0)
                     data.back() |= static_cast<Byte>(0xFF << used);
                 }),
       "modbus_rtu/data/bits_01/a3_n1", "data"},
      {"words_low_byte_first", "words are sent with the low byte first",
       edit_data(0x03, 0x04, [](Bytes& data, const Bytes&) { swap_bytes(data); }),
       "modbus_rtu/modes/serves", "data"},
      {"written_words_low_byte_first", "words are written with the low byte first",
       misread(write_words_swapped), "modbus_rtu/modes/serves", "data"},
      {"words_swapped_both_ways",
       "words are stored with their bytes swapped, which reading by words does not show",
       [] {
         Behaviour behaviour;
         behaviour.answer = [](const Bytes& frame, GoodModbus& plc) {
           const Bytes request = plc.message(frame);
           if (request.empty()) return broken::Sendings{};
           Bytes reply = plc.ask(write_words_swapped(request));
           if (function_of(reply) == 0x03) {
             Bytes data = data_of_read(reply);
             swap_bytes(data);
             reply = read_reply(request, data);
           }
           if (function_of(reply) == 0x06) reply = request;
           return reply.empty() ? broken::Sendings{} : broken::Sendings{{plc.frame(reply)}};
         };
         return behaviour;
       },
       "modbus_rtu/writes/words_then_bits", "data"},
      {"addresses_one_based", "data address 1 is the first", answer_with(one_based),
       "modbus_rtu/writes/words_then_bits", "data"},
      {"coils_and_inputs_swapped", "function code 01 reads the inputs, 02 the coils",
       reads_other_area(0x01, 0x02), "modbus_rtu/data/bits_01/a3_n8", "data"},
      {"registers_swapped", "function code 03 reads the input registers, 04 the holding registers",
       reads_other_area(0x03, 0x04), "modbus_rtu/modes/serves", "data"},
      {"writes_partly", "a write past the end writes what fits in, and refuses",
       answer_with(write_partly), "modbus_rtu/addressing/end_of_words_10/xbc_h", "%MW"},
      {"writes_what_is_missing",
       "a coil or register without its value is refused, and 0 all the same",
       answer_with([](const Bytes& request, GoodModbus& plc) {
         Bytes reply = plc.ask(request);
         const bool one = function_of(request) == 0x05 || function_of(request) == 0x06;
         if (one && request.size() < value_at + 2 && exception_of(reply) == value_error) {
           Bytes whole = request;
           whole.resize(value_at + 2);
           (void)plc.ask(whole);
         }
         return reply;
       }),
       "modbus_rtu/exceptions/length_half_address/f05", "%MW"},
      {"writes_one_register_of_many", "preset multiple registers writes the first one",
       write_first(0x10, 1), "modbus_rtu/writes/words/n2", "%MW"},
      {"writes_eight_coils_of_many", "force multiple coils writes the first byte",
       write_first(0x0F, 8), "modbus_rtu/writes/bits/a3_n13", "%MW"},
      {"writes_padding", "force multiple coils writes what pads the last byte",
       answer_with([](const Bytes& request, GoodModbus& plc) {
         Bytes reply = plc.ask(write_padding(request));
         if (function_of(reply) == 0x0F) put_word(reply, count_at, word_at(request, count_at));
         return reply;
       }),
       "modbus_rtu/writes/padding_bits/n1_fe", "%MW"},
      {"clears_the_next_word", "a write of words clears the word behind them",
       answer_with(clear_next), "modbus_rtu/writes/one_word/v1234", "%MW"},
      {"coil_on_is_off", "force single coil with FF00 switches off",
       answer_with([](const Bytes& request, GoodModbus& plc) {
         Bytes other = request;
         if (function_of(request) == 0x05 && word_at(request, value_at) == 0xFF00)
           put_word(other, value_at, 0);
         const Bytes reply = plc.ask(other);
         return function_of(reply) == 0x05 ? request : reply;
       }),
       "modbus_rtu/writes/one_bit/b0_on", "%MW"},
      {"multiple_coils_reply_04", "the reply to 0F carries 04, as the example is printed",
       edit_write_reply(0x0F, [](Bytes& reply, const Bytes&) { reply[1] = 0x04; }),
       "modbus_rtu/examples/force_multiple_coils", "function code"},
      {"single_coil_reply_0001", "the reply to force single coil carries 0001 for on",
       edit_write_reply(
           0x05,
           [](Bytes& reply, const Bytes&) { put_word(reply, value_at, reply[value_at] ? 1 : 0); }),
       "modbus_rtu/examples/force_single_coil", "value"},
      {"single_register_reply_zero", "the reply to preset single register carries 0000",
       edit_write_reply(0x06, [](Bytes& reply, const Bytes&) { put_word(reply, value_at, 0); }),
       "modbus_rtu/examples/preset_single_register", "value"},
      {"multiple_registers_reply_is_the_request", "the reply to 10 repeats the request",
       edit_write_reply(0x10, [](Bytes& reply, const Bytes& request) { reply = request; }),
       "modbus_rtu/examples/preset_multiple_registers", "echo"},
      {"multiple_registers_reply_in_bytes", "the reply to 10 counts bytes",
       edit_write_reply(0x10,
                        [](Bytes& reply, const Bytes&) {
                          put_word(reply, count_at, word_at(reply, count_at) * 2);
                        }),
       "modbus_ascii/examples/preset_multiple_registers", "count"},
  };
}

}  // namespace fieldproof::modbus_broken
