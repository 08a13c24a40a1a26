// Faults of monitor registration and execution (Cnet EN 7.1.5 (5), (6)).
#include <map>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

namespace {

constexpr std::size_t number_at = 3;  // in the body

Bytes renumbered(FrameText text, const std::string& number) {
  text.body.replace(number_at, 2, number);
  text.seal();
  return text.bytes();
}

std::string number_of(const FrameText& text) {
  return text.body.size() > number_at ? text.body.substr(number_at, 2) : std::string();
}
bool is(const FrameText& text, char service) { return (text.command() | 0x20) == service; }
bool acknowledged(const Bytes& reply) { return !reply.empty() && reply[0] == xgt_cnet::xgt_ack; }

/// Asks with another registration number, and answers with the one that was asked for.
Bytes answer_renumbered(const Bytes& request, const std::string& number, GoodPlc& plc) {
  const FrameText text = take_apart(request);
  const Bytes reply = plc.answer(renumbered(text, number));
  return reply.empty() ? reply : renumbered(take_apart(reply), number_of(text));
}

/// Number 0F does not exist.
Bytes fifteen_numbers(const Bytes& request, GoodPlc& plc) {
  const FrameText text = take_apart(request);
  if (number_of(text) == "0F" && (is(text, 'x') || is(text, 'y')))
    return answer_renumbered(request, "10", plc);
  return plc.answer(request);
}

/// Number 10 exists: it is number 00.
Bytes seventeen_numbers(const Bytes& request, GoodPlc& plc) {
  const FrameText text = take_apart(request);
  if (number_of(text) == "10" && (is(text, 'x') || is(text, 'y')))
    return answer_renumbered(request, "00", plc);
  return plc.answer(request);
}

Bytes one_number(const Bytes& request, GoodPlc& plc) {
  const FrameText text = take_apart(request);
  const std::int64_t number = xgt_cnet::hex_value(number_of(text));
  if ((is(text, 'x') || is(text, 'y')) && number >= 0 && number < 16)
    return answer_renumbered(request, "00", plc);
  return plc.answer(request);
}

/// A device that remembers what was registered, beside the good one.
using Registered = std::map<std::string, std::string>;  // number: something of the registration
using Watch = Bytes (*)(const Bytes& request, GoodPlc& plc, Registered& registered);

MakeBehaviour with_memory(Watch watch) {
  return [watch](Storage&) {
    Behaviour behaviour;
    behaviour.answer = [watch, registered = Registered()](const Bytes& request, bool,
                                                          GoodPlc& plc) mutable {
      return broken::Sendings{{watch(request, plc, registered)}};
    };
    return behaviour;
  };
}

Bytes keep_first(const Bytes& request, GoodPlc& plc, Registered& registered) {
  const FrameText text = take_apart(request);
  const xgt_cnet::XgtRequest parsed = xgt_cnet::parse_request(request);
  if (is(text, 'x') && !parsed.fault && parsed.station == plc.station() &&
      registered.contains(number_of(text)))
    return ack_to(parsed);
  const Bytes reply = plc.answer(request);
  if (is(text, 'x') && acknowledged(reply)) registered[number_of(text)];
  return reply;
}

/// Y answers with what the memory held at registration.
Bytes keep_values(const Bytes& request, GoodPlc& plc, Registered& registered) {
  const FrameText text = take_apart(request);
  const Bytes reply = plc.answer(request);
  if (!acknowledged(reply)) return reply;
  if (is(text, 'x')) {
    FrameText execution = text;
    execution.body = text.front();
    execution.body[2] = static_cast<char>(text.command() + 1);
    execution.seal();
    registered[number_of(text)] = take_apart(plc.answer(execution.bytes())).content();
  }
  if (!is(text, 'y')) return reply;
  FrameText old = take_apart(reply);
  old.body = old.front() + registered[number_of(text)];
  old.seal();
  return old.bytes();
}

/// A refused registration clears the earlier one.
Bytes forget_when_refused(const Bytes& request, GoodPlc& plc, Registered& forgotten) {
  const FrameText text = take_apart(request);
  const Bytes reply = plc.answer(request);
  if (is(text, 'x') && refusal(reply)) forgotten[number_of(text)];
  if (is(text, 'x') && acknowledged(reply)) forgotten.erase(number_of(text));
  return is(text, 'y') && acknowledged(reply) && forgotten.contains(number_of(text))
             ? nak_to(xgt_cnet::parse_request(request), xgt_cnet::xgt_error::not_registered)
             : reply;
}

/// Each registration serves once.
Bytes serve_once(const Bytes& request, GoodPlc& plc, Registered& served) {
  const FrameText text = take_apart(request);
  const Bytes reply = plc.answer(request);
  if (is(text, 'x') && acknowledged(reply)) served.erase(number_of(text));
  if (!is(text, 'y') || !acknowledged(reply)) return reply;
  return served.try_emplace(number_of(text)).second
             ? reply
             : nak_to(xgt_cnet::parse_request(request), xgt_cnet::xgt_error::not_registered);
}

/// The case of the command is part of the number.
Bytes keep_cases_apart(const Bytes& request, GoodPlc& plc, Registered& registered) {
  const FrameText text = take_apart(request);
  const Bytes reply = plc.answer(request);
  if (is(text, 'x') && acknowledged(reply))
    registered[number_of(text)] = text.lower_case() ? "lower" : "upper";
  const bool other = is(text, 'y') && acknowledged(reply) &&
                     registered[number_of(text)] != (text.lower_case() ? "lower" : "upper");
  return other ? nak_to(xgt_cnet::parse_request(request), xgt_cnet::xgt_error::not_registered)
               : reply;
}

/// What is registered is not looked at before it is executed.
Bytes accept_any_content(const Bytes& request, GoodPlc& plc) {
  const Bytes reply = plc.answer(request);
  const xgt_cnet::XgtRequest parsed = xgt_cnet::parse_request(request);
  return is(take_apart(request), 'x') && refusal(reply) &&
                 refusal(reply) != xgt_cnet::xgt_error::register_number
             ? ack_to(parsed)
             : reply;
}

Bytes empty_for_unregistered(const Bytes& request, GoodPlc& plc) {
  const Bytes reply = plc.answer(request);
  return refusal(reply) == xgt_cnet::xgt_error::not_registered
             ? ack_to(xgt_cnet::parse_request(request), "00")
             : reply;
}

Behaviour survive(Storage& storage) {
  Behaviour behaviour;
  behaviour.answer = [&storage](const Bytes& request, bool, GoodPlc& plc) {
    const Bytes reply = plc.answer(request);
    if (is(take_apart(request), 'x') && acknowledged(reply)) {
      storage.frames.push_back(request);
      if (storage.save) storage.save(storage.frames);
    }
    return broken::Sendings{{reply}};
  };
  behaviour.power_on = [&storage](GoodPlc& plc) {
    for (const Bytes& registration : storage.frames) (void)plc.answer(registration);
  };
  return behaviour;
}

}  // namespace

std::vector<Fault> monitor_faults() {
  return {
      {"registration_0f_refused", "registration number 0F is refused", answer_with(fifteen_numbers),
       "monitor_register/each_number/n0f_lower", "header"},
      {"registration_10_accepted", "registration number 10 is accepted",
       answer_with(seventeen_numbers), "monitor_register/number_out_of_range/n10_lower", "header"},
      {"one_registration_alone", "all registration numbers are the same place",
       answer_with(one_number), "monitor_register/numbers_are_separate/lower", "data"},
      {"registrations_by_case", "X registers for Y, and x for y", with_memory(keep_cases_apart),
       "monitor_execute/case_is_free/lower_then_upper", "header"},
      {"registration_keeps_the_first", "registering a number again changes nothing",
       with_memory(keep_first), "monitor_register/registered_again/lower", "data"},
      {"monitor_gives_old_values", "Y answers with the values of the moment of registration",
       with_memory(keep_values), "monitor_execute/new_value_at_each_execution/lower", "data"},
      {"refused_registration_forgets", "a refused registration clears the earlier one",
       with_memory(forget_when_refused), "monitor_register/refused_leaves_earlier/lower", "header"},
      {"registration_serves_once", "a registration is used up by its first execution",
       with_memory(serve_once), "monitor_execute/executed_again/lower", "header"},
      {"registration_unchecked", "the content of a registration is not checked",
       answer_with(accept_any_content), "monitor_register/example_nak/lower", "header"},
      {"unregistered_is_empty", "executing what is not registered draws an ACK without blocks",
       answer_with(empty_for_unregistered), "errors/code_0090/lower", "header"},
      {"monitor_reply_without_number", "replies to Y have no registration number",
       edit_reply([](FrameText& reply, const FrameText& request) {
         if (is(request, 'y') && reply.is_ack()) reply.body.erase(number_at, 2);
       }),
       "monitor_execute/example_m000/lower", "block count"},
      {"monitor_rss_without_block_count",
       "replies to Y of an individual registration have no block count",
       edit_reply([](FrameText& reply, const FrameText& request) {
         if (is(request, 'y') && reply.is_ack() &&
             xgt_cnet::parse_reply(reply.bytes()).with_block_count)
           reply.body.erase(5, 2);
       }),
       "monitor_execute/printed_rss/lower", "block count"},
      {"registrations_survive_power_off", "registrations are still there after power was off",
       survive, "monitor_execute/example_nak/lower", "header",
       "xgt_cnet/monitor_execute/example_*"},
  };
}

}  // namespace fieldproof::xgt_cnet_broken
