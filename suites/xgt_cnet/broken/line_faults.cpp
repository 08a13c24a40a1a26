// Faults of time and of the line: late, split, repeated, lost and surplus bytes, and what makes a
// device fall silent.
#include <algorithm>
#include <memory>
#include <utility>

#include "suites/xgt_cnet/broken/faults.hpp"

namespace fieldproof::xgt_cnet_broken {

using broken::Sendings;

namespace {

Bytes operator+(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

MakeBehaviour late_by(Duration delay) {
  return send_with([delay](const Bytes&, Bytes reply) {
    return Sendings{{std::move(reply), delay}};
  });
}

Sendings in_halves(const Bytes&, Bytes reply) {
  const auto middle = reply.begin() + static_cast<std::ptrdiff_t>(reply.size() / 2);
  return {{Bytes(reply.begin(), middle)}, {Bytes(middle, reply.end()), 200ms}};
}

Sendings one_byte_a_second(const Bytes&, Bytes reply) {
  Sendings sendings;
  for (const Byte b : reply)
    sendings.push_back({{b}, 1s * static_cast<Duration::rep>(sendings.size())});
  return sendings;
}

Behaviour flood_after_a_broken_frame(Storage&) {
  Behaviour behaviour;
  behaviour.cut_off = [](const Bytes&, GoodPlc&) { return Sendings{{Bytes(4000, 'U'), 1ms, 1ms}}; };
  return behaviour;
}

Behaviour swallow_every_tenth(Storage&) {
  Behaviour behaviour;
  behaviour.answer = [count = 0](const Bytes& request, bool, GoodPlc& plc) mutable {
    Bytes reply = plc.answer(request);
    return ++count % 10 == 0 ? Sendings{} : Sendings{{std::move(reply)}};
  };
  return behaviour;
}

bool has_wrong_check(const Bytes& request) {
  return xgt_cnet::parse_request(request).fault.check == xgt_cnet::XgtCheck::bcc;
}

Behaviour die_of_wrong_check(Storage&) {
  Behaviour behaviour;
  behaviour.answer = [dead = false](const Bytes& request, bool, GoodPlc& plc) mutable {
    dead = dead || has_wrong_check(request);
    return dead ? Sendings{} : Sendings{{plc.answer(request)}};
  };
  return behaviour;
}

Behaviour die_of_a_broken_frame(Storage&) {
  Behaviour behaviour;
  const auto dead = std::make_shared<bool>(false);
  behaviour.answer = [dead](const Bytes& request, bool, GoodPlc& plc) {
    return *dead ? Sendings{} : Sendings{{plc.answer(request)}};
  };
  behaviour.cut_off = [dead](const Bytes&, GoodPlc&) {
    *dead = true;
    return Sendings{};
  };
  return behaviour;
}

/// Executes what a silence has ended as if its tail had come.
Behaviour time_for_a_tail(Storage&) {
  Behaviour behaviour;
  behaviour.cut_off = [](const Bytes& heard, GoodPlc& plc) {
    FrameText text = take_apart(heard + Bytes{xgt_cnet::xgt_eot});
    if (text.lower_case()) text.check = sum_of(text.without_check());
    return Sendings{{plc.answer(text.bytes())}};
  };
  return behaviour;
}

/// An ENQ inside a frame is one more character of it. A new burst begins a new frame.
Behaviour no_restart_at_enq(Storage&) {
  Behaviour behaviour;
  behaviour.hear = [](Bytes& bytes) {
    bool inside = false;
    for (Byte& b : bytes) {
      if (b == xgt_cnet::xgt_enq && inside) b = '?';
      inside = b == xgt_cnet::xgt_enq || (inside && b != xgt_cnet::xgt_eot);
    }
  };
  return behaviour;
}

Behaviour deaf_while_busy(Storage&) {
  Behaviour behaviour;
  behaviour.answer = [](const Bytes& request, bool together, GoodPlc& plc) {
    return together ? Sendings{} : Sendings{{plc.answer(request)}};
  };
  return behaviour;
}

/// The reply of the request before.
Behaviour one_behind(Storage&) {
  Behaviour behaviour;
  behaviour.answer = [last = Bytes()](const Bytes& request, bool, GoodPlc& plc) mutable {
    Bytes reply = plc.answer(request);
    std::swap(reply, last);
    return Sendings{{reply.empty() ? last : std::move(reply)}};
  };
  return behaviour;
}

/// After a refusal one request is lost.
Behaviour deaf_after_nak(Storage&) {
  Behaviour behaviour;
  behaviour.answer = [deaf = false](const Bytes& request, bool, GoodPlc& plc) mutable {
    Bytes reply = plc.answer(request);
    if (std::exchange(deaf, false)) return Sendings{};
    deaf = refusal(reply).has_value();
    return Sendings{{std::move(reply)}};
  };
  return behaviour;
}

MakeBehaviour takes_for(Byte other, Byte right) {
  return [other, right](Storage&) {
    Behaviour behaviour;
    behaviour.hear = [other, right](Bytes& bytes) {
      std::replace(bytes.begin(), bytes.end(), other, right);
    };
    return behaviour;
  };
}

Behaviour frame_must_begin_the_line(Storage&) {
  Behaviour behaviour;
  behaviour.hear = [](Bytes& bytes) {
    if (!bytes.empty() && bytes.front() != xgt_cnet::xgt_enq && bytes.size() > 1)
      for (Byte& b : bytes)
        if (b == xgt_cnet::xgt_enq) b = '?';
  };
  return behaviour;
}

}  // namespace

std::vector<Fault> line_faults() {
  return {
      {"late_answer", "replies come after 700 ms", late_by(700ms), "errors/code_0190/lower", ""},
      {"late_refusal", "a refusal comes after 700 ms", send_with([](const Bytes&, Bytes reply) {
         const Duration delay = refusal(reply) ? 700ms : 0ms;
         return Sendings{{std::move(reply), delay}};
       }),
       "frame_structure/nak/lower", "late answer"},
      {"split_answer", "replies pause for 200 ms in the middle", send_with(in_halves),
       "errors/code_0190/lower", ""},
      {"split_refusal", "a refusal pauses for 200 ms in the middle",
       send_with([](const Bytes& request, Bytes reply) {
         return refusal(reply) ? in_halves(request, std::move(reply))
                               : Sendings{{std::move(reply)}};
       }),
       "frame_structure/nak/lower", "split answer"},
      {"one_byte_a_second", "replies come at one byte a second", send_with(one_byte_a_second),
       "errors/code_0190/lower", ""},
      {"echo", "the request comes back before a refusal",
       send_with([](const Bytes& request, Bytes reply) {
         return Sendings{{refusal(reply) ? request + reply : std::move(reply)}};
       }),
       "errors/code_0190/lower", "echo"},
      {"echo_alone", "what is to be refused comes back, and no reply",
       send_with([](const Bytes& request, Bytes reply) {
         return Sendings{{refusal(reply) ? request : std::move(reply)}};
       }),
       "errors/code_0190/lower", "echo"},
      {"reply_twice", "each reply is sent twice",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{reply + reply}}; }),
       "rss/two_words/lower", "after the complete"},
      {"reply_again_later", "each reply is sent again after 50 ms",
       send_with([](const Bytes&, Bytes reply) {
         return Sendings{{reply}, {reply, 50ms}};
       }),
       "frame_structure/no_tail_is_silent/lower/bare", "silence"},
      {"trailing_byte", "a byte 00 follows each reply",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{reply + Bytes{0}}}; }),
       "rss/two_words/lower", "after the complete"},
      {"cr_lf_behind_reply", "CR LF follow each reply", send_with([](const Bytes&, Bytes reply) {
         return Sendings{{reply + Bytes{0x0D, 0x0A}}};
       }),
       "rss/two_words/lower", "after the complete"},
      {"garbage_before_reply", "a byte FF comes before each reply",
       send_with([](const Bytes&, Bytes reply) { return Sendings{{Bytes{0xFF} + reply}}; }),
       "errors/code_0190/lower", "header"},
      {"reply_one_behind", "each reply is that to the request before", one_behind,
       "errors/code_0190/lower", "header"},
      {"swallows_every_tenth_request", "every tenth request is not answered", swallow_every_tenth,
       "monitor_execute/all_sixteen", "no answer"},
      {"floods", "sends without end after a frame without tail", flood_after_a_broken_frame,
       "frame_structure/request_ending_with_etx/lower", "floods", broken::alone},
      {"dies_of_a_wrong_bcc", "silent for ever after a wrong BCC", die_of_wrong_check,
       "frame_structure/other_sums_are_wrong/body", "no answer", broken::alone, 32},
      {"dies_of_a_missing_tail", "silent for ever after a frame without tail",
       die_of_a_broken_frame, "frame_structure/request_ending_with_etx/lower", "no answer"},
      {"needs_no_tail", "a frame without tail is executed when nothing more comes", time_for_a_tail,
       "frame_structure/no_tail_is_silent/lower/bare", "silence"},
      {"no_restart_at_enq", "ENQ inside a frame does not begin a new one", no_restart_at_enq,
       "frame_structure/enq_inside_a_frame/head", "no answer", broken::alone},
      {"etx_ends_a_request", "ETX ends a request as EOT does",
       takes_for(xgt_cnet::xgt_etx, xgt_cnet::xgt_eot),
       "frame_structure/request_ending_with_etx/upper", "silence"},
      {"stx_begins_a_request", "STX begins a request as ENQ does",
       takes_for(0x02, xgt_cnet::xgt_enq), "frame_structure/request_with_another_head/upper/stx",
       "silence"},
      {"deaf_after_nak", "the request after a refusal is not answered", deaf_after_nak,
       "errors/good_after_refused/lower", "no answer"},
      {"first_of_two_requests",
       "of two requests without a pause between them the first is answered", deaf_while_busy,
       "frame_structure/back_to_back/continuous", "no answer", broken::alone},
      {"noise_spoils_the_frame", "a frame right after other bytes is not heard",
       frame_must_begin_the_line, "frame_structure/noise_before_enq/headless", "no answer",
       broken::alone},
  };
}

}  // namespace fieldproof::xgt_cnet_broken
