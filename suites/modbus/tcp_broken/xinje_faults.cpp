// Where the objects of a XINJE PLC lie (X-NET 1-3, 3-4-2), as its server gets them wrong.
#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

constexpr unsigned inputs = 0x5000, outputs = 0x6000, area = 0x1000;

bool is_of_coils(const Bytes& request) {
  const Byte function = function_of(request);
  return function == 1 || function == 2 || function == 5 || function == 0x0F;
}
bool is_of_registers(const Bytes& request) {
  const Byte function = function_of(request);
  return function == 3 || function == 6 || function == 0x10;
}

/// Requests for coils, or registers, from `first` on are understood with another address; the reply
/// to a write names the one that was asked.
MakeBehaviour moved(bool (*concerns)(const Bytes& request), unsigned first, unsigned count,
                    unsigned (*other)(unsigned offset)) {
  const auto is_there = [=](const Bytes& request) {
    const unsigned address = word_at(request, address_at);
    return concerns(request) && address >= first && address < first + count;
  };
  return [=] {
    return Behaviour{.misread =
                         [=](Bytes request) {
                           const unsigned asked = word_at(request, address_at);
                           if (is_there(request))
                             put_word(request, address_at, first + other(asked - first));
                           return request;
                         },
                     .edit =
                         [=](Bytes& reply, const Bytes& request) {
                           const bool writes = function_of(request) > 4;
                           if (writes && is_there(request) && !is_exception(reply))
                             put_word(reply, address_at, word_at(request, address_at));
                         }};
  };
}

/// Numbers that are no octal ones have places, too: X10 lies at 10.
unsigned decimal(unsigned offset) { return offset / 10 * 8 + offset % 10; }
unsigned next(unsigned offset) { return offset + 1; }
unsigned next_area(unsigned offset) { return offset + area; }

/// The last of an area of whole 1000s is refused.
MakeBehaviour ends_early(bool (*concerns)(const Bytes& request)) {
  return edits([=](Bytes& reply, const Bytes& request) {
    const unsigned end = word_at(request, address_at) + word_at(request, count_at);
    if (concerns(request) && end % area == 0) reply = exception_to(request, 2);
  });
}

/// What lies behind an area reads as 0.
MakeBehaviour empty_behind(bool (*concerns)(const Bytes& request)) {
  return edits([=](Bytes& reply, const Bytes& request) {
    if (!concerns(request) || function_of(request) > 4 || !is_exception(reply) || reply.back() != 2)
      return;
    const unsigned count = word_at(request, count_at);
    const unsigned bytes = is_of_coils(request) ? (count + 7) / 8 : 2 * count;
    reply.resize(pdu_at);
    reply.push_back(function_of(request));
    reply.push_back(static_cast<Byte>(bytes));
    reply.resize(reply.size() + bytes);
    set_length(reply);
  });
}

}  // namespace

std::vector<Fault> xinje_faults() {
  return {
      {"xinje_inputs_in_decimal", "inputs are numbered in decimal: X20 lies at 20",
       moved(is_of_coils, inputs, area, decimal), "modbus_tcp/xinje/octal_inputs/x20", ""},
      {"xinje_outputs_in_decimal", "outputs are numbered in decimal: Y20 lies at 20",
       moved(is_of_coils, outputs, area, decimal), "modbus_tcp/xinje/octal_outputs/y20", ""},
      {"xinje_inputs_from_1", "the first input is X1", moved(is_of_coils, inputs, area, next),
       "modbus_tcp/xinje/hmi_coils", ""},
      {"xinje_registers_one_further", "registers lie one address further",
       moved(is_of_registers, 0, 0x10000, next), "modbus_tcp/xinje/hmi_words", ""},
      {"xinje_sd_is_td", "where SD belongs TD lies",
       moved(is_of_registers, 0x7000, area, next_area), "modbus_tcp/xinje/read_registers/sd", ""},
      {"xinje_s_of_next_area", "where S belongs the next coils lie",
       moved(is_of_coils, 0x7000, area, next_area), "modbus_tcp/xinje/read_coils/s", ""},
      {"xinje_coils_end_early", "the last coil before the next area is refused",
       ends_early(is_of_coils), "modbus_tcp/xinje/before_the_next_coils/m", ""},
      {"xinje_registers_end_early", "the last register before the next area is refused",
       ends_early(is_of_registers), "modbus_tcp/xinje/before_the_next_registers/td", ""},
      {"xinje_coils_without_end", "coils behind the last of an area read as 0",
       empty_behind(is_of_coils), "modbus_tcp/xinje/nothing_behind/x", ""},
      {"xinje_registers_without_end", "registers behind the last of an area read as 0",
       empty_behind(is_of_registers), "modbus_tcp/xinje/nothing_behind/qd", ""},
  };
}

}  // namespace fieldproof::modbus_tcp_broken
