// Faults of time and of the line: late, split, repeated, lost and surplus bytes, where frames begin
// and end, and what makes a device fall silent.
#include <algorithm>
#include <utility>

#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

using broken::Sendings;

namespace {

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Sendings in_halves(const Bytes&, Bytes reply) {
  const auto middle = reply.begin() + static_cast<std::ptrdiff_t>(reply.size() / 2);
  return {{Bytes(reply.begin(), middle)}, {Bytes(middle, reply.end()), 200ms}};
}

/// An ENQ inside a frame is one more character of it. A new burst begins a new frame.
Behaviour no_restart_at_enq() {
  Behaviour behaviour;
  behaviour.hear = [](Bytes& bytes) {
    bool inside = false;
    for (Byte& b : bytes) {
      if (b == ls_bus::ls_enq && inside) b = '?';
      inside = b == ls_bus::ls_enq || (inside && b != ls_bus::ls_eot);
    }
  };
  return behaviour;
}

/// A frame whose sum is right is executed before its EOT.
Behaviour needs_no_eot() {
  Behaviour behaviour;
  behaviour.hear = [](Bytes& bytes) {
    if (bytes.empty() || bytes.front() != ls_bus::ls_enq || bytes.back() == ls_bus::ls_eot) return;
    Bytes ended = bytes + Bytes{ls_bus::ls_eot};
    if (take_apart(ended).is_sealed()) bytes = std::move(ended);
  };
  return behaviour;
}

MakeBehaviour takes_for(Byte other, Byte right) {
  return [=] {
    Behaviour behaviour;
    behaviour.hear = [=](Bytes& bytes) { std::replace(bytes.begin(), bytes.end(), other, right); };
    return behaviour;
  };
}

Behaviour frame_must_begin_the_line() {
  Behaviour behaviour;
  behaviour.hear = [](Bytes& bytes) {
    if (!bytes.empty() && bytes.front() != ls_bus::ls_enq)
      std::replace(bytes.begin(), bytes.end(), ls_bus::ls_enq, Byte{'?'});
  };
  return behaviour;
}

/// Begins a frame where there is no ENQ: at what follows EOT.
Behaviour needs_no_enq() {
  Behaviour behaviour;
  behaviour.hear = [](Bytes& bytes) {
    if (!bytes.empty() && bytes.front() >= '0' && bytes.front() <= '9')
      bytes.insert(bytes.begin(), ls_bus::ls_enq);
  };
  return behaviour;
}

Behaviour deaf_while_busy() {
  Behaviour behaviour;
  behaviour.answer = [](const Bytes& frame, bool together, GoodInverter& inverter) {
    return together ? Sendings{} : Sendings{{inverter.answer(frame)}};
  };
  return behaviour;
}

/// The reply to the request before.
Behaviour one_behind() {
  Behaviour behaviour;
  behaviour.answer = [last = Bytes()](const Bytes& frame, bool, GoodInverter& inverter) mutable {
    Bytes reply = inverter.answer(frame);
    std::swap(reply, last);
    return Sendings{{reply.empty() ? last : std::move(reply)}};
  };
  return behaviour;
}

/// After a refusal one request is lost.
Behaviour deaf_after_nak() {
  Behaviour behaviour;
  behaviour.answer = [deaf = false](const Bytes& frame, bool, GoodInverter& inverter) mutable {
    Bytes reply = inverter.answer(frame);
    if (std::exchange(deaf, false)) return Sendings{};
    deaf = !reply.empty() && reply[0] == ls_bus::ls_nak;
    return Sendings{{std::move(reply)}};
  };
  return behaviour;
}

/// Silent for ever after a frame that it does not answer.
Behaviour dies_of_silence() {
  Behaviour behaviour;
  behaviour.answer = [dead = false](const Bytes& frame, bool, GoodInverter& inverter) mutable {
    Bytes reply = inverter.answer(frame);
    dead = dead || reply.empty();
    return dead ? Sendings{} : Sendings{{std::move(reply)}};
  };
  return behaviour;
}

/// Its buffer is of 44 bytes, and what does not fit kills it.
Behaviour dies_of_a_long_frame() {
  Behaviour behaviour;
  behaviour.hear = [held = std::size_t{0}, dead = false](Bytes& bytes) mutable {
    for (const Byte b : bytes) {
      held = b == ls_bus::ls_enq || b == ls_bus::ls_eot ? 0 : held + 1;
      dead = dead || held > ls_bus::ls_max_frame;
    }
    if (dead) bytes.clear();
  };
  return behaviour;
}

}  // namespace

std::vector<Fault> line_faults() {
  return {
      {"late_answer", "replies come after 700 ms", send_with([](const Bytes&, Bytes reply) {
         return Sendings{{std::move(reply), 700ms}};
       }),
       "errors/format_of_the_nak_r", "late answer"},
      {"split_answer", "replies pause for 200 ms in the middle", send_with(in_halves),
       "errors/format_of_the_nak_r", "split answer"},
      {"echo", "the request comes back before a refusal",
       send_with([](const Bytes& request, Bytes reply) {
         const bool refused = !reply.empty() && reply[0] == ls_bus::ls_nak;
         return Sendings{{refused ? request + reply : std::move(reply)}};
       }),
       "errors/format_of_the_nak_r", "echo"},
      {"reply_twice", "each reply is sent twice",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{reply + reply}}; }),
       "read/count/words_2", "after the complete"},
      {"trailing_byte", "a byte 00 follows each reply",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{reply + Bytes{0}}}; }),
       "read/count/words_2", "after the complete"},
      {"garbage_before_reply", "a byte FF comes before each reply",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{Bytes{0xFF} + reply}}; }),
       "errors/format_of_the_nak_r", "header"},
      {"reply_one_behind", "each reply is that to the request before", one_behind,
       "errors/format_of_the_nak_r", "header"},
      {"no_restart_at_enq", "ENQ inside a frame does not begin a new one", no_restart_at_enq,
       "frame_structure/enq_inside_a_frame/command", "header", broken::alone},
      {"etx_ends_a_request", "ETX ends a request as EOT does", takes_for(0x03, ls_bus::ls_eot),
       "frame_structure/etx_for_eot", "silence"},
      {"stx_begins_a_request", "STX begins a request as ENQ does", takes_for(0x02, ls_bus::ls_enq),
       "frame_structure/reply_of_another/stx", "silence"},
      {"ack_begins_a_request", "ACK begins a request as ENQ does",
       takes_for(ls_bus::ls_ack, ls_bus::ls_enq), "frame_structure/reply_of_another/ack_of_one",
       "silence"},
      {"needs_no_eot", "a frame without EOT is executed when its sum is right", needs_no_eot,
       "frame_structure/cut_off/sum", "silence", broken::alone},
      {"needs_no_enq", "a frame without ENQ is executed", needs_no_enq,
       "frame_structure/headless_before_enq", "data", broken::alone},
      {"noise_spoils_the_frame", "a frame right after other bytes is not heard",
       frame_must_begin_the_line, "frame_structure/before_enq/zeros", "no answer", broken::alone},
      {"first_of_two_requests",
       "of two requests without a pause between them the first is answered", deaf_while_busy,
       "frame_structure/two_requests", "no answer", broken::alone},
      {"deaf_after_nak", "the request after a refusal is not answered", deaf_after_nak,
       "errors/count_read/9", "no answer", broken::alone},
      {"dies_of_another_station", "silent for ever after a request to another station",
       dies_of_silence, "stations/other_station_read", "no answer", broken::alone},
      {"dies_of_a_long_frame", "silent for ever after more than 44 bytes without EOT",
       dies_of_a_long_frame, "frame_structure/endless_frame", "no answer", broken::alone},
  };
}

}  // namespace fieldproof::ls_bus_broken
