#include "suites/ls_bus/broken/faults.hpp"

namespace fieldproof::ls_bus_broken {

namespace {
MakeBehaviour answering(std::function<Bytes(const Bytes& frame, GoodInverter& inverter)> answer) {
  return [answer = std::move(answer)] {
    Behaviour behaviour;
    behaviour.answer = [answer](const Bytes& frame, bool, GoodInverter& inverter) {
      return broken::Sendings{{answer(frame, inverter)}};
    };
    return behaviour;
  };
}
}  // namespace

const std::vector<Fault>& faults() {
  static const std::vector<Fault> table = broken::gather<Fault>(
      {check_faults, reply_faults, request_faults, line_faults, narrow_faults});
  return table;
}

const Fault* find_fault(std::string_view name) {
  const Fault* fault = broken::find_by_name(faults(), name);
  return fault ? fault : broken::find_by_name(back_door_faults(), name);
}

MakeBehaviour spoil_frame(std::function<void(FrameText& reply, const FrameText& request)> edit) {
  return answering([edit = std::move(edit)](const Bytes& frame, GoodInverter& inverter) {
    const Bytes reply = inverter.answer(frame);
    if (reply.empty()) return reply;
    FrameText text = take_apart(reply);
    edit(text, take_apart(frame));
    return text.bytes();
  });
}

MakeBehaviour edit_reply(std::function<void(FrameText& reply, const FrameText& request)> edit) {
  return spoil_frame([edit = std::move(edit)](FrameText& reply, const FrameText& request) {
    edit(reply, request);
    reply.seal();
  });
}

MakeBehaviour misread(std::function<void(FrameText& request)> read) {
  return answering([read = std::move(read)](const Bytes& frame, GoodInverter& inverter) {
    FrameText request = take_apart(frame);
    const bool sealed = request.is_sealed();
    read(request);
    if (sealed) request.seal();
    return inverter.answer(request.bytes());
  });
}

MakeBehaviour answer_with(std::function<FrameText(const FrameText& request, const FrameText& right,
                                                  GoodInverter& inverter)>
                              answer) {
  return answering([answer = std::move(answer)](const Bytes& frame, GoodInverter& inverter) {
    const FrameText request = take_apart(frame);
    const Bytes right = inverter.answer(frame);
    if (right.empty() || !request.is_sealed()) return right;
    return answer(request, take_apart(right), inverter).bytes();
  });
}

MakeBehaviour send_with(std::function<broken::Sendings(const Bytes& request, Bytes reply)> send) {
  return [send = std::move(send)] {
    Behaviour behaviour;
    behaviour.answer = [send](const Bytes& frame, bool, GoodInverter& inverter) {
      Bytes reply = inverter.answer(frame);
      return reply.empty() ? broken::Sendings{} : send(frame, std::move(reply));
    };
    return behaviour;
  };
}

}  // namespace fieldproof::ls_bus_broken
