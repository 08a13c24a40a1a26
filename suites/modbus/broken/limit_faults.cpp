// Faults in what is accepted: counts, addresses, lengths, values (Cnet EN 6.1.3, 9.3.3, 9.4).
#include <algorithm>

#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

namespace {

/// Reads `limit` elements and one more, and joins them.
Bytes read_in_two(const Bytes& request, GoodModbus& plc, unsigned limit) {
  Bytes first = request, rest = request;
  put_word(first, count_at, limit);
  put_word(rest, count_at, 1);
  put_word(rest, address_at, word_at(request, address_at) + limit);
  const Bytes a = plc.ask(first), b = plc.ask(rest);
  if (exception_of(a)) return a;
  if (exception_of(b)) return b;
  Bytes data = data_of_read(a);
  const Bytes more = data_of_read(b);
  data.insert(data.end(), more.begin(), more.end());
  return read_reply(request, data);
}

Bytes write_in_two(const Bytes& request, GoodModbus& plc, unsigned limit) {
  const Bytes data = data_of_write(request);
  const std::size_t half = is_bits(function_of(request)) ? limit / 8 : limit * 2;
  if (data.size() <= half) return plc.ask(request);
  const auto middle = data.begin() + static_cast<std::ptrdiff_t>(half);
  const unsigned address = word_at(request, address_at);
  const Bytes a = plc.ask(write_many(request, address, limit, Bytes(data.begin(), middle)));
  const Bytes b = plc.ask(write_many(request, address + limit, 1, Bytes(middle, data.end())));
  if (exception_of(a)) return a;
  return exception_of(b) ? b : Bytes(request.begin(), request.begin() + 6);
}

/// Takes one element more than the limit.
MakeBehaviour one_more(Byte function, unsigned limit) {
  return answer_with([function, limit](const Bytes& request, GoodModbus& plc) {
    const Bytes reply = plc.ask(request);
    if (exception_of(reply) != value_error || function_of(request) != function ||
        word_at(request, count_at) != limit + 1)
      return reply;
    return is_read(function) ? read_in_two(request, plc, limit) : write_in_two(request, plc, limit);
  });
}

/// Refuses with `code` where `refuses` says so.
MakeBehaviour refuse(Byte code, std::function<bool(const Bytes& request)> refuses) {
  return answer_with([code, refuses = std::move(refuses)](const Bytes& request, GoodModbus& plc) {
    const bool own = request[0] == plc.station();
    return own && refuses(request) ? exception_to(request, code) : plc.ask(request);
  });
}

MakeBehaviour one_less(Byte function, unsigned limit) {
  return refuse(value_error, [function, limit](const Bytes& request) {
    return function_of(request) == function && word_at(request, count_at) == limit;
  });
}

unsigned elements(const Bytes& request) {
  const Byte function = function_of(request);
  return function == 0x05 || function == 0x06 ? 1 : word_at(request, count_at);
}

/// Refuses the last element of each table: the one behind it is refused rightly.
Bytes refuse_last(const Bytes& request, GoodModbus& plc) {
  const Bytes reply = plc.ask(request);
  if (reply.empty() || exception_of(reply) || request.size() < 6) return reply;
  const Byte read = function_of(request) == 0x02 || function_of(request) == 0x04
                        ? function_of(request)
                    : is_bits(function_of(request)) ? 0x01
                                                    : 0x03;
  Bytes behind{request[0], read, 0, 0, 0, 1};
  put_word(behind, address_at, word_at(request, address_at) + elements(request));
  return exception_of(plc.ask(behind)) == address_error ? exception_to(request, address_error)
                                                        : reply;
}

/// What lies past the end is read as `count` zeros, and not written.
Bytes zeros_past_the_end(const Bytes& request, GoodModbus& plc) {
  const Bytes reply = plc.ask(request);
  if (exception_of(reply) != address_error) return reply;
  if (!is_read(function_of(request))) return Bytes(request.begin(), request.begin() + 6);
  const unsigned count = word_at(request, count_at);
  return read_reply(request, Bytes(is_bits(function_of(request)) ? (count + 7) / 8 : count * 2, 0));
}

/// A word past the end begins again at the base.
Bytes wrapped(const Bytes& request, GoodModbus& plc) {
  const Bytes reply = plc.ask(request);
  if (exception_of(reply) != address_error) return reply;
  Bytes other = request;
  put_word(other, address_at, 0);
  return plc.ask(other);
}

MakeBehaviour forgive(std::function<bool(Bytes& request)> change) {
  return answer_with([change = std::move(change)](const Bytes& request, GoodModbus& plc) {
    const Bytes reply = plc.ask(request);
    Bytes other = request;
    if (exception_of(reply) != value_error || !change(other)) return reply;
    return plc.ask(other);
  });
}

/// Requests 01 to 06 have six bytes.
bool cut_surplus(Bytes& request) {
  const bool longer = request.size() > 6 && function_of(request) <= 0x06;
  if (longer) request.resize(6);
  return longer;
}

/// Believes the count where the byte count differs.
bool believe_count(Bytes& request) {
  if (function_of(request) < 0x0F || request.size() < 8) return false;
  const unsigned count = word_at(request, count_at);
  const std::size_t due = is_bits(function_of(request)) ? (count + 7) / 8 : count * 2;
  Bytes data = data_of_write(request);
  data.resize(due);
  const Bytes right = write_many(request, word_at(request, address_at), count, data);
  const bool other = right != request;
  request = right;
  return other;
}

}  // namespace

std::vector<Fault> limit_faults() {
  return {
      {"reads_2001_coils", "2001 coils are read", one_more(0x01, 2000),
       "modbus_rtu/limits/read_bits_refused/c07d1", "function code"},
      {"reads_2001_inputs", "2001 inputs are read", one_more(0x02, 2000),
       "modbus_rtu/limits/read_inputs_refused/c07d1", "function code"},
      {"reads_126_holding_registers", "126 holding registers are read", one_more(0x03, 125),
       "modbus_rtu/limits/read_words_refused/c007e", "function code"},
      {"reads_126_input_registers", "126 input registers are read", one_more(0x04, 125),
       "modbus_rtu/limits/read_input_words_refused/c007e", "function code"},
      {"writes_1969_coils", "1969 coils are written", one_more(0x0F, 1968),
       "modbus_rtu/limits/write_bits_07b1_refused", "function code"},
      {"writes_121_registers", "121 registers are written", one_more(0x10, 120),
       "modbus_rtu/limits/write_words_121_refused", "function code"},
      {"refuses_2000_coils", "2000 coils are one too many to read", one_less(0x01, 2000),
       "modbus_rtu/limits/read_bits_2000", "function code"},
      {"refuses_120_holding_registers", "120 holding registers are one too many to read",
       one_less(0x03, 120), "modbus_rtu/limits/read_words_120", "function code"},
      {"refuses_1968_coils", "1968 coils are one too many to write", one_less(0x0F, 1968),
       "modbus_rtu/limits/write_bits_1968", "function code"},
      {"refuses_120_registers", "120 registers are one too many to write", one_less(0x10, 120),
       "modbus_rtu/limits/write_words_120", "function code"},
      {"count_zero_accepted", "a read of nothing is answered with no data",
       answer_with([](const Bytes& request, GoodModbus& plc) {
         const bool nothing = is_read(function_of(request)) && request.size() == 6 &&
                              word_at(request, count_at) == 0;
         return nothing && request[0] == plc.station() ? read_reply(request, {}) : plc.ask(request);
       }),
       "modbus_rtu/limits/read_words_refused/c0000", "function code"},
      {"last_address_refused", "the last address of each area is refused", answer_with(refuse_last),
       "modbus_rtu/addressing/end_of_bits_01/xbc_h", "exception to Read Coil Status"},
      {"past_the_end_is_zero", "what lies past the end of an area reads 0",
       answer_with(zeros_past_the_end), "modbus_rtu/exceptions/address_read/f03/a4000",
       "function code"},
      {"addresses_wrap", "an address past the end begins again at the base", answer_with(wrapped),
       "modbus_ascii/exceptions/address_read/f03/affff", "function code"},
      {"surplus_ignored", "what follows the last field is not looked at", forgive(cut_surplus),
       "modbus_rtu/exceptions/length_one_more/f03", "function code"},
      {"byte_count_ignored", "the byte count of writes is not looked at", forgive(believe_count),
       "modbus_rtu/exceptions/words_too_small", "function code"},
      {"any_coil_value_accepted", "force single coil takes any value but 0000 for on",
       forgive([](Bytes& request) {
         if (function_of(request) != 0x05 || request.size() != 6) return false;
         put_word(request, value_at, 0xFF00);
         return true;
       }),
       "modbus_rtu/exceptions/force_value/v0001/off", "function code"},
  };
}

}  // namespace fieldproof::modbus_broken
