// Faults of exceptions: which code, which form (Cnet EN 9.2.2, Appendix 3.2).
#include "suites/modbus/broken/faults.hpp"

namespace fieldproof::modbus_broken {

namespace {

MakeBehaviour edit_exception(void (*edit)(Bytes& reply)) {
  return edit_reply([edit](Bytes& reply, const Bytes&) {
    if (exception_of(reply)) edit(reply);
  });
}

MakeBehaviour other_code(Byte right, Byte wrong) {
  return edit_reply([right, wrong](Bytes& reply, const Bytes&) {
    if (exception_of(reply) == right) reply[2] = wrong;
  });
}

}  // namespace

std::vector<Fault> exception_faults() {
  return {
      {"exception_bit_missing", "an exception carries the function code without 80",
       edit_exception([](Bytes& r) { r[1] &= 0x7F; }),
       "modbus_rtu/examples/read_holding_registers_refused", "function code"},
      {"exception_function_80", "an exception carries 80 instead of the function code",
       edit_exception([](Bytes& r) { r[1] = 0x80; }),
       "modbus_rtu/examples/read_holding_registers_refused", "function code"},
      {"exception_in_two_bytes", "the exception code has two bytes",
       edit_exception([](Bytes& r) { r.insert(r.begin() + 2, 0); }),
       "modbus_rtu/examples/read_holding_registers_refused", "exception code"},
      {"exception_without_code", "an exception has no code",
       edit_exception([](Bytes& r) { r.pop_back(); }),
       "modbus_ascii/examples/read_coil_status_refused", "exception code"},
      {"unknown_function_03", "an unknown function draws exception 03",
       other_code(function_error, value_error), "modbus_rtu/exceptions/function_unknown/f07",
       "exception code"},
      {"unknown_function_silent", "an unknown function draws silence",
       answer_with([](const Bytes& request, GoodModbus& plc) {
         const Bytes reply = plc.ask(request);
         return exception_of(reply) == function_error ? Bytes{} : reply;
       }),
       "modbus_rtu/exceptions/function_unknown/f07", "no answer", broken::alone},
      {"address_error_03", "an address past the end draws exception 03",
       other_code(address_error, value_error), "modbus_rtu/exceptions/address_read/f03/affff",
       "exception code"},
      {"value_error_02", "a count or value that is not allowed draws exception 02",
       other_code(value_error, address_error), "modbus_rtu/limits/read_words_refused/c007e",
       "exception code"},
      {"always_error_04", "every exception is 04", edit_exception([](Bytes& r) { r[2] = 4; }),
       "modbus_ascii/exceptions/address_read/f01/affff", "exception code"},
      {"exceptions_silent", "where an exception is due nothing is sent",
       answer_with([](const Bytes& request, GoodModbus& plc) {
         const Bytes reply = plc.ask(request);
         return exception_of(reply) ? Bytes{} : reply;
       }),
       "modbus_rtu/exceptions/address_read/f03/affff", "no answer", broken::alone},
  };
}

}  // namespace fieldproof::modbus_broken
