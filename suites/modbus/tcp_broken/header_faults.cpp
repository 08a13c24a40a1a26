// Faults of the MBAP header: transaction, protocol, length, unit (FEnet EN 5.3.3).
#include <algorithm>

#include "suites/modbus/tcp_broken/faults.hpp"

namespace fieldproof::modbus_tcp_broken {

namespace {

/// Numbers its replies itself.
Behaviour counting() {
  return {.edit = [next = 0u](Bytes& reply, const Bytes&) mutable { put_word(reply, 0, ++next); }};
}

/// Remembers what the first request was numbered.
Behaviour first_transaction() {
  return {.edit = [first = Bytes{}](Bytes& reply, const Bytes& request) mutable {
    if (first.empty()) first.assign(request.begin(), request.begin() + 2);
    std::ranges::copy(first, reply.begin());
  }};
}

/// A request of another protocol is understood as Modbus where `takes` says so.
Behaviour takes_protocol(bool (*takes)(unsigned protocol),
                         std::function<void(Bytes& reply, const Bytes& request)> edit = {}) {
  return {.misread =
              [takes](Bytes request) {
                if (takes(word_at(request, protocol_at))) put_word(request, protocol_at, 0);
                return request;
              },
          .edit = std::move(edit)};
}

Bytes without_surplus(Bytes request) {
  const bool fixed = function_of(request) >= 1 && function_of(request) <= 6;
  constexpr std::size_t whole = 12;
  if (!fixed || request.size() <= whole) return request;
  request.resize(whole);
  set_length(request);
  return request;
}

/// Lengths that no frame has are passed over with all that came with them.
Bursts deaf_to(Burst heard, bool (*length)(unsigned)) {
  const bool bad = heard.event == LinkEvent::data && heard.bytes.size() >= unit_at &&
                   length(word_at(heard.bytes, length_at));
  return bad ? Bursts{} : Bursts{std::move(heard)};
}

}  // namespace

std::vector<Fault> header_faults() {
  const auto any = [](unsigned) { return true; };
  return {
      {"transaction_zero", "replies have transaction 0",
       edits([](Bytes& reply, const Bytes&) { put_word(reply, 0, 0); }),
       "modbus_tcp/mbap/transaction/ta55a", "transaction"},
      {"transaction_of_one_byte", "the high byte of the transaction is lost",
       edits([](Bytes& reply, const Bytes&) { reply[0] = 0; }), "modbus_tcp/mbap/transaction/t0100",
       "transaction"},
      {"transaction_swapped", "the bytes of the transaction change places",
       edits([](Bytes& reply, const Bytes&) { std::swap(reply[0], reply[1]); }),
       "modbus_tcp/mbap/transaction/t0001", "transaction"},
      {"transaction_counted", "the server numbers its replies itself", counting,
       "modbus_tcp/mbap/transaction_any_order", "transaction"},
      {"transaction_of_the_first", "all replies have the first transaction", first_transaction,
       "modbus_tcp/mbap/transaction_any_order", "transaction"},
      {"transaction_lost_in_errors", "error frames have transaction 0",
       edits([](Bytes& reply, const Bytes&) {
         if (is_exception(reply)) put_word(reply, 0, 0);
       }),
       "modbus_tcp/mbap/transaction_of_an_error", "transaction"},
      {"repeated_transaction_ignored", "a transaction that was just used is no request",
       [] {
         return Behaviour{.misread = [last = Bytes{}](Bytes request) mutable {
           Bytes number(request.begin(), request.begin() + 2);
           const bool again = number == last;
           last = std::move(number);
           return again ? Bytes{} : request;
         }};
       },
       "modbus_tcp/mbap/transaction_again", "no answer"},
      {"unit_of_its_own", "replies have unit 1",
       edits([](Bytes& reply, const Bytes&) { reply[unit_at] = 1; }), "modbus_tcp/mbap/unit/u02",
       "unit"},
      {"unit_lost_in_errors", "error frames have unit 0", edits([](Bytes& reply, const Bytes&) {
         if (is_exception(reply)) reply[unit_at] = 0;
       }),
       "modbus_tcp/mbap/unit_of_an_error", "unit"},
      {"other_units_ignored", "requests to another unit than 1 are not answered",
       misreads([](Bytes request) { return request[unit_at] == 1 ? request : Bytes{}; }),
       "modbus_tcp/mbap/unit/uff", "no answer"},
      {"unit_zero_is_broadcast", "requests to unit 0 are not answered",
       misreads([](Bytes request) { return request[unit_at] == 0 ? Bytes{} : request; }),
       "modbus_tcp/mbap/unit/u00", "no answer"},
      {"writes_to_other_units_lost", "writes to another unit than 1 are acknowledged, not done",
       [] {
         return Behaviour{.misread =
                              [](Bytes request) {
                                if (function_of(request) == 6 && request[unit_at] != 1) {
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
       "modbus_tcp/mbap/unit_writes/u02", "%MW"},
      {"other_protocol_answered", "a request of another protocol is answered in its name",
       [any] {
         return takes_protocol(any, [](Bytes& reply, const Bytes& request) {
           put_word(reply, protocol_at, word_at(request, protocol_at));
         });
       },
       "modbus_tcp/mbap/protocol/p0001", "silence"},
      {"other_protocol_is_modbus", "the protocol is not looked at",
       [any] { return takes_protocol(any); }, "modbus_tcp/mbap/protocol/p8000", "silence"},
      {"protocol_of_one_byte", "the high byte of the protocol is not looked at",
       [] { return takes_protocol([](unsigned protocol) { return protocol % 256 == 0; }); },
       "modbus_tcp/mbap/protocol/p0100", "silence"},
      {"other_protocol_written", "a write of another protocol is done without an answer",
       [] {
         Behaviour one = takes_protocol([](unsigned) { return true; });
         one.edit = [](Bytes& reply, const Bytes& request) {
           if (word_at(request, protocol_at) != 0) reply.clear();
         };
         return one;
       },
       "modbus_tcp/mbap/protocol_write", "%MW"},
      {"other_protocol_refused", "another protocol draws exception 01",
       [any] {
         return takes_protocol(any, [](Bytes& reply, const Bytes& request) {
           if (word_at(request, protocol_at) != 0) reply = exception_to(request, 1);
         });
       },
       "modbus_tcp/mbap/protocol_error", "silence"},
      {"other_protocol_ends_segment", "what comes with a frame of another protocol is lost",
       hears([](Burst heard, Server&) {
         const bool other =
             heard.event == LinkEvent::data && word_at(heard.bytes, protocol_at) != 0;
         return other ? Bursts{} : Bursts{std::move(heard)};
       }),
       "modbus_tcp/mbap/protocol_one_segment", "no answer"},
      {"length_without_unit", "the length of replies leaves the unit out",
       edits([](Bytes& reply, const Bytes&) { --reply[length_at + 1]; }),
       "modbus_tcp/mbap/length_of_reply/word", "length"},
      {"length_one_more", "the length of replies is one more",
       edits([](Bytes& reply, const Bytes&) { ++reply[length_at + 1]; }),
       "modbus_tcp/mbap/length_of_reply/write", "length"},
      {"length_of_the_whole", "the length of replies counts the header",
       edits([](Bytes& reply, const Bytes&) {
         put_word(reply, length_at, static_cast<unsigned>(reply.size()));
       }),
       "modbus_tcp/mbap/length_of_reply/words", "length"},
      {"length_low_byte_first", "the length of replies has its low byte first",
       edits([](Bytes& reply, const Bytes&) { std::swap(reply[length_at], reply[length_at + 1]); }),
       "modbus_tcp/mbap/length_of_reply/coil", "length"},
      {"length_of_request", "replies have the length of the request",
       edits([](Bytes& reply, const Bytes& request) {
         put_word(reply, length_at, word_at(request, length_at));
       }),
       "modbus_tcp/mbap/length_of_reply/error", "length"},
      {"cut_request_ignored", "a request that its length cuts is not answered",
       misreads([](Bytes request) { return request.size() < 12 ? Bytes{} : request; }),
       "modbus_tcp/mbap/length_cut_pdu/f03_4", "no answer"},
      {"surplus_ignored", "what is more than a request needs is not looked at",
       misreads(without_surplus), "modbus_tcp/mbap/length_surplus/n7", "function code"},
      {"length_zero_passed_over", "length 0 is passed over", hears([](Burst heard, Server&) {
         return deaf_to(std::move(heard), [](unsigned length) { return length == 0; });
       }),
       "modbus_tcp/mbap/length_reset/n0", "did not close"},
      {"long_length_awaited", "of a length that no frame has the rest is awaited",
       hears([](Burst heard, Server&) {
         return deaf_to(std::move(heard), [](unsigned length) { return length > 260; });
       }),
       "modbus_tcp/mbap/length_reset/n65535", "did not close"},
      {"bad_length_ends_all", "a length that no frame has ends all connections",
       acts([](Bursts& does, Server& server) {
         if (std::ranges::none_of(does,
                                  [](const Burst& one) { return one.event == LinkEvent::reset; }))
           return;
         for (const LinkId link : server.links)
           does.push_back({.bytes = {}, .start = {}, .link = link, .event = LinkEvent::reset});
       }),
       "modbus_tcp/mbap/length_reset/n261", "reset"},
  };
}

}  // namespace fieldproof::modbus_tcp_broken
